#include "render/lights/delta_light.h"

#include <algorithm>

namespace velour {

int find_sharp_light(const Lighting& lighting, const Vertex& vertex, PathNumbers& numbers,
                     std::span<SharpLight> found) {
  const auto lamps = lighting.sharp();
  const size_t room = std::min(found.size(), kMaxDeltaLights);
  const bool all = lamps.size() <= room;
  const size_t count = all ? lamps.size() : room;
  Vec2 u[kMaxDeltaLights];
  LightView view;
  if (!all) view = lighting.sharp_view(vertex.light_place());
  if (!all) numbers.points(Purpose::sharp, numbers.ray() * static_cast<uint32_t>(room), {u, room});
  int lit = 0;
  for (size_t i = 0; i < count; ++i) {
    float probability = 1.0f;
    const size_t chosen = all ? i : lighting.choose_sharp(view, u[i].x, probability);
    const Lamp::Irradiance light = lamps[chosen].irradiance(vertex.position);
    const Vec3 wl = vertex.frame.to_local(light.direction);
    if (!vertex.receives_light(wl, light.direction)) continue;
    const float share = all ? 1.0f : 1.0f / (static_cast<float>(room) * probability);
    found[static_cast<size_t>(lit++)] = {&lamps[chosen], light.distance, wl, light.direction,
                                         share * light.perpendicular};
  }
  return lit;
}

}  // namespace velour
