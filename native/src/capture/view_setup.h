// One view of a capture: its direction and its lights.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "btf/pair_layout.h"
#include "capture/repeated_tile.h"

namespace velour {

struct CaptureLight {
  Vec3 wl;
  uint32_t number;       // index in the layout's set
  float per_irradiance;  // 1 / |cos(theta_l)|: the light's irradiance on the reference plane is its cosine
  RepeatedTile::Ends ends;
};

/// Maximum number of lights that are tested together.
inline constexpr uint32_t kLightsTogether = 128;

/// A group of a view's lights, as a structure of arrays.
struct LightGroup {
  std::span<const CaptureLight> lights;
  alignas(64) float x[kLightsTogether] = {}, y[kLightsTogether] = {}, z[kLightsTogether] = {};
  alignas(64) float per_irradiance[kLightsTogether] = {};

  /// Lights [first, first + kLightsTogether) of `all`, or fewer at its end.
  LightGroup(std::span<const CaptureLight> all, size_t first)
      : lights(all.subspan(first, std::min<size_t>(kLightsTogether, all.size() - first))) {
    for (size_t l = 0; l < lights.size(); ++l) {
      x[l] = lights[l].wl.x;
      y[l] = lights[l].wl.y;
      z[l] = lights[l].wl.z;
      per_irradiance[l] = lights[l].per_irradiance;
    }
  }
  uint32_t count() const { return static_cast<uint32_t>(lights.size()); }
};

struct ViewSetup {
  uint32_t number = 0;
  Vec3 wv{0, 0, 1};
  std::vector<CaptureLight> lights;

  ViewSetup(const RepeatedTile& tile, const PairLayout& layout, uint32_t view) : number(view) {
    wv = unit_direction(layout.views()[view]);
    for (uint64_t pair = layout.first(view); pair < layout.first(view + 1); ++pair) {
      const uint32_t light = layout.light_of(pair);
      const Vec3 wl = unit_direction(layout.lights()[light]);
      lights.push_back({wl, light, 1 / std::abs(wl.z), tile.ends(wl)});
    }
  }
};

}  // namespace velour
