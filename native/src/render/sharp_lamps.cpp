#include "render/sharp_lamps.h"

namespace velour {

int find_sharp_light(const Lighting& lighting, const Vertex& vertex, PathNumbers& numbers,
                     SharpLight (&found)[kSharpLamps]) {
  const auto lamps = lighting.sharp();
  const bool all = lamps.size() <= kSharpLamps;
  const int count = all ? static_cast<int>(lamps.size()) : kSharpLamps;
  Vec2 u[kSharpLamps];
  if (!all) numbers.points(Purpose::sharp, numbers.ray() * kSharpLamps, u);
  int lit = 0;
  for (int i = 0; i < count; ++i) {
    float probability = 1.0f;
    const size_t chosen = all ? static_cast<size_t>(i) : lighting.choose_sharp(u[i].x, probability);
    const Lamp::Irradiance light = lamps[chosen].irradiance(vertex.position);
    const Vec3 wl = vertex.frame.to_local(light.direction);
    if (!(wl.z > 0.0f) || !(glm::dot(light.direction, vertex.geometric_normal) > 0.0f)) continue;
    const float share = all ? 1.0f : 1.0f / (kSharpLamps * probability);
    found[lit++] = {&lamps[chosen], light.distance, wl, light.direction, share * light.perpendicular};
  }
  return lit;
}

}  // namespace velour
