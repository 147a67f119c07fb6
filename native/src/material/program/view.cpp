// Blender's nodes that depend on the view or change the normal (kernel/svm/fresnel.h, bump.h, tex_coord.h of Cycles).
#include <algorithm>
#include <cmath>
#include "material/program/operands.h"

namespace velour {
namespace {

/// Reflectance of a smooth dielectric for unpolarized light [CT82]; `eta`: the index behind the surface over that
/// before.
float fresnel_at(float cosine, float eta) {
  const float c = std::abs(cosine), g_sq = eta * eta - 1 + c * c;
  if (!(g_sq > 0)) return 1;  // total reflection
  const float g = std::sqrt(g_sq), a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
  return 0.5f * a * a * (1 + b * b);
}

float facing(float cosine, float blend) {
  const float c = std::abs(cosine);
  if (blend == 0.5f) return 1 - c;
  const float limited = std::clamp(blend, 0.0f, 1 - 1e-5f);
  return 1 - std::pow(c, limited < 0.5f ? 2 * limited : 0.5f / (1 - limited));
}

/// A tangent-space normal map: `color` encodes components along the axes (columns), which bend by `strength`.
Vec3 map_normal(const Rgb& color, float strength, const Mat3& axes, const Vec3& otherwise) {
  const Vec3 map = 2.0f * color - 1.0f;
  const Vec3 normal = axes * Vec3(strength * map.x, strength * map.y, mixed(1, map.z, saturated(strength)));
  const float length = glm::length(normal);
  return length > 0 && std::isfinite(length) ? normal / length : otherwise;
}

/// Normal of the surface raised by a height, from its differences along two steps on the surface [Mik20].
Vec3 bumped(const Vec3& normal, float difference_x, float difference_y, const Vec3& step_x, const Vec3& step_y,
            float distance, float strength) {
  const Vec3 across_x = glm::cross(step_y, normal), across_y = glm::cross(normal, step_x);
  const float area = glm::dot(step_x, across_x);
  const Vec3 gradient = difference_x * across_x + difference_y * across_y;
  const Vec3 raised = unit_or_zero(std::abs(area) * normal - (area < 0 ? -distance : distance) * gradient);
  if (raised == Vec3(0.0f)) return normal;
  const Vec3 mixed_normal = unit_or_zero(strength * raised + (1 - strength) * normal);
  return std::isfinite(mixed_normal.x + mixed_normal.y + mixed_normal.z) ? mixed_normal : normal;
}

}  // namespace

void run_view(const Operands& operands) {
  const Operands& o = operands;
  const auto cosine = [&](int i) { return glm::dot(o.vector(2, i), o.vector(1, i)); };
  const auto is_back = [&](int i) { return o.number(3, i) != 0; };
  switch (o.at.operation) {
    case Operation::fresnel:
      return o.each([&](int i) {
        const float eta = std::max(o.number(0, i), 1e-5f);
        o.out()[i] = fresnel_at(cosine(i), is_back(i) ? 1 / eta : eta);
      });
    case Operation::layer_weight:
      return o.each([&](int i) {
        const float eta = std::max(1 - o.number(0, i), 1e-5f);
        o.out(0)[i] = fresnel_at(cosine(i), is_back(i) ? eta : 1 / eta);
        o.out(1)[i] = facing(cosine(i), o.number(0, i));
      });
    case Operation::normal_map:
      return o.each([&](int i) {
        const Mat3 axes(o.vector(2, i), o.vector(3, i), o.vector(4, i));
        o.set(0, i, map_normal(o.vector(0, i), o.number(1, i), axes, o.vector(5, i)));
      });
    case Operation::bump:
      return o.each([&](int i) {
        const float height = o.number(2, i);
        o.set(0, i,
              bumped(o.vector(5, i), o.number(3, i) - height, o.number(4, i) - height, o.vector(6, i), o.vector(7, i),
                     o.number(1, i), std::max(o.number(0, i), 0.0f)));
      });
    default:
      return;
  }
}

}  // namespace velour
