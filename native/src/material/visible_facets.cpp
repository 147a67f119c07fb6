#include "material/visible_facets.h"

#include <algorithm>
#include <cmath>

#include "material/ggx.h"
#include "sphere/quadrature.h"

namespace velour {
namespace {

constexpr int kRadii = 24, kTurns = 24;
static_assert(kRadii * kTurns == VisibleFacets::kCount);

/// Points on the half of the disk of visible normals to one side of the plane of incidence; the other half is its
/// mirror image. Arrays let the compiler vectorize.
struct DiskPoints {
  static constexpr int kCount = VisibleFacets::kCount;
  float radius[kCount], sine[kCount];   // for p2 of Heitz 2018, Listing 1
  float along[kCount], beside[kCount];  // p1, and sqrt(1 - p1^2)
  double weight[kCount];

  DiskPoints() {
    const Quadrature radii = gauss_legendre(kRadii, 0, 1);
    for (int i = 0; i < kCount; ++i) {
      const auto ring = static_cast<size_t>(i / kTurns);
      const float turn = 0.5f * (static_cast<float>(i % kTurns) + 0.5f) / kTurns - 0.25f, phi = 2 * kPi * turn;
      radius[i] = static_cast<float>(radii.node[ring]);
      sine[i] = std::sin(phi);
      along[i] = radius[i] * std::cos(phi);
      beside[i] = std::sqrt(std::max(0.0f, 1 - along[i] * along[i]));
      weight[i] = 2 * radii.node[ring] * radii.weight[ring] / kTurns;
    }
  }
};

const DiskPoints& disk_points() {
  static const DiskPoints points;
  return points;
}

}  // namespace

/// Evaluates sample_ggx_visible_normal() at all points.
VisibleFacets::VisibleFacets(const Vec3& wv, const Vec2& alpha) {
  const DiskPoints& points = disk_points();
  const Vec3 stretched = glm::normalize(Vec3(alpha.x * wv.x, 0, wv.z));
  const float s = 0.5f * (1 + stretched.z), length_v = ggx_projected_length(wv, alpha);
  // The axes of the disk are y and, in the plane of incidence, (-stretched.z, 0, stretched.x), or x and y for a view
  // along the normal.
  const bool tilted = stretched.x > 0;
  const Vec3 t1 = tilted ? Vec3(0, 1, 0) : Vec3(1, 0, 0), t2 = glm::cross(stretched, t1);
  for (int i = 0; i < kCount; ++i) {
    const float p1 = points.along[i], p2 = (1 - s) * points.beside[i] + s * points.radius[i] * points.sine[i];
    const float up = std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
    const float x = alpha.x * (p1 * t1.x + p2 * t2.x + up * stretched.x);
    const float y = alpha.y * (p1 * t1.y + p2 * t2.y + up * stretched.y);
    const float z = std::max(0.0f, p1 * t1.z + p2 * t2.z + up * stretched.z);
    const float scale = 1 / std::sqrt(x * x + y * y + z * z);
    const float facing = std::min(wv.x * (x * scale) + wv.z * (z * scale), 1.0f);
    const float lx = 2 * facing * (x * scale) - wv.x, ly = 2 * facing * (y * scale);
    const float lz = 2 * facing * (z * scale) - wv.z;
    const float ax = alpha.x * lx, ay = alpha.y * ly;
    const float length_l = std::sqrt(lz * lz + ax * ax + ay * ay);
    const float kept = lz * (wv.z + length_v) / (lz * length_v + wv.z * length_l);
    cosine[i] = facing;
    masking[i] = facing > 0 && lz > 0 ? kept : 0.0f;
  }
}

const double* VisibleFacets::weights() { return disk_points().weight; }

}  // namespace velour
