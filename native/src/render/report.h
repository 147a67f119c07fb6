// Report of a render: the keys printed by the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace velour {

struct RenderStage {
  std::string name;
  double seconds;
};

struct RenderReport {
  double seconds = 0;               // tracing and shading only
  uint64_t rays = 0;                // camera, shadow and continuation rays
  double samples_per_second = 0;    // pixels x spp / seconds
  std::optional<double> ray_share;  // seconds of the recorded rays alone / seconds of their tiles
  std::vector<RenderStage> stages;  // in order; "render" is `seconds`
  uint64_t nan_samples = 0;         // light directions dropped because they were not finite
  uint64_t spp = 0;                 // maximum number of light directions of a pixel
  uint64_t passes = 0;
  double noise = 0;        // estimated RMS error of a pixel's luminance / mean luminance; 0 while unknown
  double spp_mean = 0;     // light directions, mean over the pixels
  double block_noise = 0;  // largest relative error of a block (noise_target.h); 0 while unknown
  std::optional<uint64_t> blocks_unfinished;  // above the target when the render ended; empty without a target
  /// The mixture that `product` used for the environment (SkyMixture).
  struct Sky {
    uint64_t lobes;
    double relative_l2, seconds;
    bool cached;
  };
  std::optional<Sky> sky;
};

}  // namespace velour
