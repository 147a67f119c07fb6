// Directional albedos by quadrature.
#pragma once

#include "math/sphere/quadrature.h"
#include "support/materials.h"

namespace velour::test {

/// Green albedo of a material at a view, integrated over `polar` x `turns` light directions.
inline double albedo(const PreparedBrdf& point, int polar, int turns) {
  const Quadrature z = gauss_legendre(polar, 0, 1);
  double sum = 0;
  for (size_t i = 0; i < z.node.size(); ++i) {
    const double r = std::sqrt(1 - z.node[i] * z.node[i]);
    for (int k = 0; k < turns; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / turns;
      const Vec3 wl(r * std::cos(phi), r * std::sin(phi), z.node[i]);
      sum += z.weight[i] * z.node[i] * static_cast<double>(eval_one(point, wl).f.g);
    }
  }
  return sum * 2 * kPiD / turns;
}

/// The same where the surface does not vary; for lobes that 120 x 160 light directions resolve.
inline double albedo(const Material& material, const Vec3& wv, int polar = 120, int turns = 160) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  return albedo(*point, polar, turns);
}

}  // namespace velour::test
