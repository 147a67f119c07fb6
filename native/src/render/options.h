// What a render is asked for.
#pragma once

#include <cstdint>
#include <string>

namespace velour {

/// How light directions are drawn. The converged picture is the same for all.
enum class Strategy : int {  // values of velour.h
  uniform = 0,               // over the hemisphere of the shading normal
  cosine = 1,                // proportional to the cosine
  table = 2,                 // tabulated f cos of the material
  srbf = 3,                  // the material's own sampler
  light = 4,                 // environment and lamps
  mis = 5,                   // half from the material, half from the lights, balance heuristic
  product = 6,               // half from BRDF times sky, the rest as mis, balance heuristic
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
  bool measure_ray_share = false;
  /// Where `product` keeps its fits of skies; empty: nowhere. The picture does not depend on it.
  std::string cache_folder;
  int camera_rays_per_pass = 0;  // 0: chosen; the picture does not depend on it

  static constexpr int kMaxSplit = 48;  // a batch of 64 directions also holds those of up to 4 sharp lamps
};

}  // namespace velour
