#include "material/specular_albedo.h"

#include <algorithm>
#include <cmath>

#include "material/ggx.h"
#include "sphere/quadrature.h"

namespace velour {

namespace {

/// Points of the half disk of visible normals that lies to one side of the plane of incidence: the other side is its
/// mirror image. As arrays, so that the compiler computes several at once.
struct DiskPoints {
  static constexpr int kRadii = 24, kTurns = 24, kCount = kRadii * kTurns;
  float radius[kCount], sine[kCount];   // p2 of Heitz 2018, Listing 1, is made of these
  float along[kCount], beside[kCount];  // p1, and sqrt(1 - p1^2)
  double weight[kCount];

  DiskPoints() {
    const Quadrature radii = gauss_legendre(kRadii, 0, 1);
    for (int i = 0; i < kCount; ++i) {
      const auto ring = static_cast<size_t>(i / kTurns);
      const auto r = static_cast<float>(radii.node[ring]);
      const float turn = 0.5f * (static_cast<float>(i % kTurns) + 0.5f) / kTurns - 0.25f, phi = 2 * kPi * turn;
      radius[i] = std::sqrt(r * r);
      sine[i] = std::sin(phi);
      along[i] = radius[i] * std::cos(phi);
      beside[i] = std::sqrt(std::max(0.0f, 1 - along[i] * along[i]));
      weight[i] = 2 * radii.node[ring] * radii.weight[ring] / kTurns;
    }
  }
};

/// What each point adds but for its weight and Fresnel: G2 / G1, 0 where the mirrored direction is below the horizon.
struct Reflected {
  float cosine[DiskPoints::kCount], masking[DiskPoints::kCount];
};

/// sample_ggx_visible_normal() at all points, for a view in the plane of x and z.
void reflect(const DiskPoints& points, const Vec3& wv, const Vec2& alpha, Reflected& out) {
  const Vec3 stretched = glm::normalize(Vec3(alpha.x * wv.x, 0, wv.z));
  const float s = 0.5f * (1 + stretched.z), length_v = ggx_projected_length(wv, alpha);
  // The axes of the disk are y and, in the plane of incidence, (-stretched.z, 0, stretched.x), or x and y for a view
  // along the normal.
  const bool tilted = stretched.x > 0;
  const Vec3 t1 = tilted ? Vec3(0, 1, 0) : Vec3(1, 0, 0), t2 = glm::cross(stretched, t1);
  for (int i = 0; i < DiskPoints::kCount; ++i) {
    const float p1 = points.along[i], p2 = (1 - s) * points.beside[i] + s * points.radius[i] * points.sine[i];
    const float up = std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
    const float x = alpha.x * (p1 * t1.x + p2 * t2.x + up * stretched.x);
    const float y = alpha.y * (p1 * t1.y + p2 * t2.y + up * stretched.y);
    const float z = std::max(0.0f, p1 * t1.z + p2 * t2.z + up * stretched.z);
    const float scale = 1 / std::sqrt(x * x + y * y + z * z);
    const float cosine = std::min(wv.x * (x * scale) + wv.z * (z * scale), 1.0f);
    const float lx = 2 * cosine * (x * scale) - wv.x, ly = 2 * cosine * (y * scale);
    const float lz = 2 * cosine * (z * scale) - wv.z;
    const float ax = alpha.x * lx, ay = alpha.y * ly;
    const float length_l = std::sqrt(lz * lz + ax * ax + ay * ay);
    const float masking = lz * (wv.z + length_v) / (lz * length_v + wv.z * length_l);
    out.cosine[i] = cosine;
    out.masking[i] = cosine > 0 && lz > 0 ? masking : 0.0f;
  }
}

/// Mean of F G2 / G1 over visible normals: the integrand is smooth whatever the roughness.
float integrate_albedo(const Vec3& wv, const Vec2& alpha, const Fresnel& fresnel) {
  static const DiskPoints points;
  Reflected reflected;
  reflect(points, wv, alpha, reflected);
  double sum = 0;
  for (int i = 0; i < DiskPoints::kCount; ++i) {
    if (reflected.masking[i] > 0) sum += points.weight[i] * reflected.masking[i] * fresnel(reflected.cosine[i]);
  }
  return static_cast<float>(std::clamp(sum, 0.0, 1.0));
}

}  // namespace

SpecularAlbedo::SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel) {
  for (size_t i = 0; i < kEntries; ++i) {
    const float root = static_cast<float>(i) / (kEntries - 1);
    const float cosine = root * root;
    albedo_[i] = integrate_albedo({std::sqrt(1 - cosine * cosine), 0, cosine}, alpha, fresnel);
  }
  mean_ = integrated();
}

SpecularAlbedo SpecularAlbedo::layered(const SpecularAlbedo& above, float weight, const SpecularAlbedo& below) {
  SpecularAlbedo both;
  for (size_t i = 0; i < kEntries; ++i) {
    both.albedo_[i] = 1 - (1 - weight * above.albedo_[i]) * (1 - below.albedo_[i]);
  }
  both.mean_ = both.integrated();
  return both;
}

SpecularAlbedo SpecularAlbedo::between(const SpecularAlbedo& a, const SpecularAlbedo& b, float share) {
  SpecularAlbedo mixed;
  for (size_t i = 0; i < kEntries; ++i) mixed.albedo_[i] = (1 - share) * a.albedo_[i] + share * b.albedo_[i];
  mixed.mean_ = (1 - share) * a.mean_ + share * b.mean_;
  return mixed;
}

float SpecularAlbedo::integrated() const {
  double mean = 0;
  for (int i = 0; i + 1 < kEntries; ++i) {  // mu = s^2: 4 int albedo s^3 ds, a quartic on each piece
    const Quadrature piece = gauss_legendre(3, i / (kEntries - 1.0), (i + 1) / (kEntries - 1.0));
    for (size_t k = 0; k < piece.node.size(); ++k) {
      const double s = piece.node[k];
      mean += 4 * s * s * s * piece.weight[k] * at(static_cast<float>(s * s));
    }
  }
  return static_cast<float>(mean);
}

float SpecularAlbedo::at(float cosine) const { return albedo_at(albedo_, cosine); }

}  // namespace velour
