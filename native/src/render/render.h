// Renders an image of a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "base/progress.h"
#include "render/film/film.h"
#include "render/options.h"
#include "scene/scene.h"

namespace velour {

// Report of a render: the keys printed by the command line.

struct RenderStage {
  std::string name;
  double seconds;
};

struct RenderReport {
  double seconds = 0;               // tracing and shading only, of the pilot, too
  uint64_t rays = 0;                // camera, shadow and continuation rays
  double samples_per_second = 0;    // pixels x spp / seconds
  std::optional<double> ray_share;  // seconds of the recorded rays alone / seconds of their tiles
  std::vector<RenderStage> stages;  // in order; `seconds` are those of "pilot" and "render"
  uint64_t nan_samples = 0;         // light directions and emissions dropped because they were not finite
  uint64_t spp = 0;                 // maximum number of light directions of a pixel
  uint64_t passes = 0;
  double noise = 0;        // estimated RMS error of a pixel's luminance / mean luminance; 0 while unknown
  double spp_mean = 0;     // light directions, mean over the pixels
  double block_noise = 0;  // largest relative error of a block (noise_target.h); 0 while unknown
  std::optional<uint64_t> blocks_unfinished;  // above the target when the render ended; empty without a target
  /// The mixture that `product` used for the environment (EnvironmentMixture).
  struct Sky {
    uint64_t lobes;
    double relative_l2, seconds;
    bool cached;
  };
  std::optional<Sky> sky;
  /// What `automatic` chose (pilot.h), as means over the pilot's pixels that show a surface.
  struct Pilot {
    uint64_t pixels;
    double products;     // share lit by `product`
    double light_share;  // RenderOptions::light_share
  };
  std::optional<Pilot> pilot;
};

/// Renders a committed scene into `film`, whose window must be that of `options`; clears it first unless
/// options.onto_film. Throws Error(invalid_argument) naming the option at fault, Error(invalid_state) if the scene is
/// not committed, and Error(cancelled): then the film holds what was done.
///
/// The image is a function of scene, options (except threads and camera_rays_per_pass) and seed, bit for bit. A crop
/// has the same bits as the whole image there. Ranges of samples have the same camera rays as the whole, and so add up
/// to it within rounding.
RenderReport render(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress);

}  // namespace velour
