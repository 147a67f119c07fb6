// What a render is asked for.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "render/light_paths.h"
#include "render/pixel_rect.h"

namespace velour {

/// How light directions are drawn. The converged picture is the same for all.
enum class Strategy : int {  // values of velour.h
  uniform = 0,               // over the hemisphere of the shading normal
  cosine = 1,                // proportional to the cosine
  table = 2,                 // tabulated f cos of the material
  srbf = 3,                  // the material's own sampler
  light = 4,                 // environment and lamps
  mis = 5,                   // some from the material, some from the lights: light_share, heuristic
  ggx = 6,                   // a GGX lobe over a diffuse base fitted to the material
  mis_ggx = 7,               // as mis, with that lobe in the material's place
  product = 8,               // three quarters or less from BRDF times sky, the rest from lights and BRDF
  dissertation = 9,          // scattered models: the interpolated densities of the nearest views [T09 7.3]
  mis_dissertation = 10,     // as mis, with those densities in the place of the material's
};
inline constexpr Strategy kLastStrategy = Strategy::mis_dissertation;

/// Some directions from the surface side, some from the lights.
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

/// The dissertation's sampling: its densities, and independent numbers.
constexpr bool is_dissertations(Strategy strategy) {
  return strategy == Strategy::dissertation || strategy == Strategy::mis_dissertation;
}

/// Weights of mixed strategies (combination.h).
enum class Heuristic : int { balance = 0, power = 1 };  // of the environment; values of velour.h

/// Where random numbers come from (path_numbers.h).
enum class Sequence : int { random = 0, sobol = 1, independent = 2 };  // values of velour.h
inline constexpr Sequence kLastSequence = Sequence::independent;

/// Some of the light directions of a pixel, [begin, end) of spp: whole camera rays.
struct SampleRange {
  int begin = 0, end = 0;  // end 0: spp
};

struct RenderOptions {
  int width = 640, height = 480;
  int spp = 64;   // light directions a pixel
  int split = 8;  // of them, how many share one camera ray; 1..kMaxSplit
  int bounces = 0;
  Strategy strategy = Strategy::mis;
  int threads = 0;  // 0: all
  uint64_t seed = 0;
  double time_limit = 0;  // seconds of tracing and shading; 0: none; a render stops at a whole pass
  bool transparent = false;
  bool hide_world = false;  // camera rays that meet nothing are black
  bool measure_ray_share = false;
  bool onto_film = false;  // adds to what the film has, whose camera rays come before
  /// Where `product` keeps its fits of skies; empty: nowhere. The picture does not depend on it.
  std::string cache_folder;
  int camera_rays_per_pass = 0;  // 0: chosen; the picture does not depend on it
  float light_share = 0.5f;  // of the directions of mixed strategies (less products), how many the lights draw; 0..1
  Heuristic heuristic = Heuristic::balance;
  Sequence sequence = Sequence::sobol;  // not of the dissertation's strategies: numbers()
  LightPathOptions light_paths;
  bool denoise =
      false;         // the film keeps independent halves (pass::kHalves), and `noise` is that of the denoised picture
  double noise = 0;  // relative error of a block of pixels at which it is done (noise_target.h); 0: all of spp
  /// Parts of a picture, for several machines: what is rendered of it has the bits that the whole has there. Neither
  /// goes with a noise target, which looks at the whole.
  SampleRange samples;
  PixelRect crop{};                         // no pixels: all
  const std::atomic<bool>* stop = nullptr;  // set from any thread: the render ends at a whole pass, soon

  Sequence numbers() const { return is_dissertations(strategy) ? Sequence::independent : sequence; }
  PixelRect window() const { return crop == PixelRect{} ? PixelRect{0, 0, width, height} : crop; }

  static constexpr int kMaxSplit = 48;  // a batch of 64 directions also holds those of up to 4 sharp lamps
};

}  // namespace velour
