// Directional albedos by quadrature.
#pragma once

#include "sphere/quadrature.h"
#include "support/materials.h"

namespace velour::test {

/// Of green, for lobes that 120 x 160 light directions resolve.
inline double albedo(const Material& material, const Vec3& wv) {
  const Quadrature z = gauss_legendre(120, 0, 1);
  constexpr int kTurns = 160;
  PreparedBrdf point;
  material.prepare(wv, point);
  double sum = 0;
  for (size_t i = 0; i < z.node.size(); ++i) {
    const double r = std::sqrt(1 - z.node[i] * z.node[i]);
    for (int k = 0; k < kTurns; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kTurns;
      const Vec3 wl(r * std::cos(phi), r * std::sin(phi), z.node[i]);
      sum += z.weight[i] * z.node[i] * static_cast<double>(eval_one(material, point, wl).f.g);
    }
  }
  return sum * 2 * kPiD / kTurns;
}

}  // namespace velour::test
