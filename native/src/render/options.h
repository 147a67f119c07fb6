// Options of a render.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include "material/surface_site.h"
#include "math/sphere/vec.h"

namespace velour {

// Cycles' settings against fireflies, with the same meaning. All of them bias the image, and are off by default.

struct LightPathOptions {
  /// Maximum mean of the channels of one sample's light that comes straight from emitters to the first surface or the
  /// camera, and of all its other light. 0: no limit.
  float clamp_direct = 0, clamp_indirect = 0;
  float filter_glossy = 0;  // roughens lobes after directions of a density below it; 0: off
  bool reflective_caustics = true;

  /// Maximum sum of the channels of a contribution at a surface after `bounces` bounces; infinite: no limit.
  float limit(int bounces) const {
    const float mean = bounces > 0 ? clamp_indirect : clamp_direct;
    return mean > 0.0f ? 3.0f * mean : std::numeric_limits<float>::infinity();
  }
};

/// State that earlier bounces of a path pass on to later surfaces.
struct PathPast {
  float least_density = std::numeric_limits<float>::infinity();  // minimum over the sampled directions, 1/sr
  bool was_diffuse = false;                                      // whether the last bounce was diffuse
  bool was_transmitted = false;                                  // whether the last bounce went through the surface
};

/// As in Cycles (kernel/integrator/surface_shader.h, kernel/svm/closure.h).
inline LobeFilter lobe_filter(const LightPathOptions& options, const PathPast& past) {
  LobeFilter filter;
  if (past.least_density < options.filter_glossy) {
    filter.min_alpha = 0.5f * std::sqrt(1.0f - past.least_density / options.filter_glossy);
  }
  filter.diffuse_only = !options.reflective_caustics && past.was_diffuse;
  return filter;
}

/// `light`, scaled down to the sum `limit` if it is brighter; its hue stays.
inline Rgb clamped(const Rgb& light, float limit) {
  const float sum = std::abs(light.r) + std::abs(light.g) + std::abs(light.b);
  return sum > limit ? light * (limit / sum) : light;
}

// Rectangle of pixels.

struct PixelRect {
  int x0, y0, x1, y1;  // [x0, x1) x [y0, y1); row 0 is at the bottom
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool operator==(const PixelRect&) const = default;
};

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
  automatic = 11,            // mis or product, and its light_share, by material: whichever a pilot found best (pilot.h)
};
inline constexpr Strategy kLastStrategy = Strategy::automatic;

/// Whether some directions are sampled from the surface and some from the lights.
constexpr bool is_mixed(Strategy strategy) {
  switch (strategy) {
    case Strategy::mis:
    case Strategy::mis_ggx:
    case Strategy::product:
    case Strategy::mis_dissertation:
    case Strategy::automatic:
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

/// Weights of mixed strategies (direction_sampling.h).
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
  Strategy strategy = Strategy::automatic;
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
