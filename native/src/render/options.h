// Options of a render.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "render/light_paths.h"
#include "render/pixel_rect.h"

namespace velour {

/// How light directions are sampled. All strategies converge to the same image.
enum class Strategy : int {  // values of velour.h
  uniform = 0,               // over the hemisphere of the shading normal
  cosine = 1,                // proportional to the cosine
  table = 2,                 // tabulated f cos of the material
  srbf = 3,                  // the material's own sampler
  light = 4,                 // environment and lights
  mis = 5,                   // some from the material, some from the lights: light_share, heuristic
  ggx = 6,                   // a GGX lobe over a diffuse base fitted to the material
  mis_ggx = 7,               // as mis, with that lobe instead of the material
  product = 8,               // three quarters or less from BRDF times environment, the rest from lights and BRDF
  dissertation = 9,          // per-view models: the interpolated densities of the nearest views [T09 7.3]
  mis_dissertation = 10,     // as mis, with those densities instead of the material's
};
inline constexpr Strategy kLastStrategy = Strategy::mis_dissertation;

/// Whether some directions are sampled from the surface and some from the lights.
constexpr bool is_mixed(Strategy strategy) {
  switch (strategy) {
    case Strategy::mis:
    case Strategy::mis_ggx:
    case Strategy::product:
    case Strategy::mis_dissertation:
      return true;
    case Strategy::uniform:
    case Strategy::cosine:
    case Strategy::table:
    case Strategy::srbf:
    case Strategy::light:
    case Strategy::ggx:
    case Strategy::dissertation:
      break;
  }
  return false;
}

/// The dissertation's sampling: its densities, and independent random numbers.
constexpr bool is_dissertations(Strategy strategy) {
  return strategy == Strategy::dissertation || strategy == Strategy::mis_dissertation;
}

/// Weights of mixed strategies (combination.h).
enum class Heuristic : int { balance = 0, power = 1 };  // for the environment; values of velour.h

/// Source of random numbers (path_numbers.h).
enum class Sequence : int { random = 0, sobol = 1, independent = 2 };  // values of velour.h
inline constexpr Sequence kLastSequence = Sequence::independent;

/// Range [begin, end) of the spp light directions of a pixel: whole camera rays.
struct SampleRange {
  int begin = 0, end = 0;  // end 0: spp
};

struct RenderOptions {
  int width = 640, height = 480;
  int spp = 64;   // light directions per pixel
  int split = 8;  // light directions that share a camera ray; 1..kMaxSplit
  int bounces = 0;
  Strategy strategy = Strategy::mis;
  int threads = 0;  // 0: all
  uint64_t seed = 0;
  double time_limit = 0;  // seconds of tracing and shading; 0: no limit; a render stops after a whole pass
  bool transparent = false;
  bool hide_world = false;  // camera rays that hit nothing are black
  bool measure_ray_share = false;
  bool onto_film = false;  // adds to the film, whose camera rays precede these
  /// Folder in which `product` caches its fits of environments; empty: no cache. Does not affect the image.
  std::string cache_folder;
  int camera_rays_per_pass = 0;  // 0: automatic; does not affect the image
  float light_share = 0.5f;      // light-sampled share of the directions of mixed strategies (without products); 0..1
  Heuristic heuristic = Heuristic::balance;
  Sequence sequence = Sequence::sobol;  // not for the dissertation's strategies: numbers()
  LightPathOptions light_paths;
  bool denoise = false;  // the film keeps independent halves (pass::kHalves); `noise` refers to the denoised image
  double noise = 0;      // relative error at which a block of pixels is done (noise_target.h); 0: render all spp
  /// Part of an image, for several machines: what is rendered has the same bits as in the whole image. Cannot be
  /// combined with a noise target, which needs the whole image.
  SampleRange samples;
  PixelRect crop{};                         // empty: the whole image
  const std::atomic<bool>* stop = nullptr;  // set from any thread: the render ends soon, after a whole pass

  Sequence numbers() const { return is_dissertations(strategy) ? Sequence::independent : sequence; }
  PixelRect window() const { return crop == PixelRect{} ? PixelRect{0, 0, width, height} : crop; }

  static constexpr int kMaxSplit = 48;  // a batch of 64 directions also holds those of up to 4 delta lights
};

}  // namespace velour
