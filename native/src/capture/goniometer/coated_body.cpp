#include "capture/goniometer/coated_body.h"

#include <algorithm>
#include <cmath>
#include <vector>
#include "brdf/measure/spectrum.h"
#include "math/sphere/frame.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

constexpr int kMaxMeetings = 64;     // with the body, for light that the interface keeps reflecting back
constexpr int kMaxReflections = 64;  // within the body
constexpr double kPatchWidth = 4.0;  // of pigment patches, in correlation lengths

/// `w` refracted to the other side of the interface; `eta` = index on this side / index on the other. z is 0 for total
/// reflection.
Vec3 refracted(const Vec3& w, float eta) {
  const float sin_sq = eta * eta * (w.x * w.x + w.y * w.y);
  return {eta * w.x, eta * w.y, std::sqrt(std::max(0.0f, 1.0f - sin_sq))};
}

}  // namespace

Reflectance interface_of(const CoatedBody& body) { return Reflectance({body.ior}); }

BodyBelow::BodyBelow(const CoatedBody& body, uint64_t seed, uint64_t stream)
    : body_(body), interface_(interface_of(body)) {
  if (!body.has_flakes()) return;
  HeightFieldOptions flakes;
  flakes.roughness = body.flake_roughness;
  surface_.emplace(make_height_field(flakes, seed, stream),
                   make_patches(flakes.cells, kPatchWidth * flakes.correlation, body.pigment_share, seed, stream + 1));
}

/// Follows light from `inside`, a direction above the body, until it leaves upward; returns that direction.
Vec3 BodyBelow::scatter(const Vec3& inside, Rgb& weight, RandomStream& random) const {
  if (!surface_) {
    weight *= body_.pigment_albedo;
    return sample_cosine_hemisphere(random.next2());
  }
  FacetPoint at;
  Vec3 arriving = inside;
  Fate fate = surface_->trace(surface_->place_above(random.next2()), -inside, at);
  for (int reflection = 0; reflection < kMaxReflections && fate == Fate::hit; ++reflection) {
    Vec3 leaving;
    if (at.base) {
      weight *= body_.pigment_albedo;
      leaving = Frame::about(at.normal).to_world(sample_cosine_hemisphere(random.next2()));
    } else {
      const float cosine = glm::dot(arriving, at.normal);
      weight *= body_.flakes.at(cosine);
      leaving = 2.0f * cosine * at.normal - arriving;
    }
    fate = surface_->trace(at.position, leaving, at);
    if (fate == Fate::escaped) return leaving;
    arriving = -leaving;
  }
  weight = Rgb(0);
  return {0, 0, 1};
}

Vec3 BodyBelow::through(Vec3 arriving, Rgb& weight, RandomStream& random) const {
  const auto ior = static_cast<float>(body_.ior);
  Vec3 inside = refracted(arriving, 1.0f / ior);
  for (int meeting = 0; meeting < kMaxMeetings && weight != Rgb(0); ++meeting) {
    inside = scatter(inside, weight, random);
    const Vec3 out = refracted(inside, ior);
    if (out.z > 0.0f && random.next() >= interface_.at(out.z).r) return out;
    inside = {-inside.x, -inside.y, inside.z};  // back along the ray that the interface reflects down
  }
  weight = Rgb(0);
  return {0, 0, 1};
}

double fresnel_reflectance(const RefractiveIndex& index, double cos_theta) {
  const double cos_sq = cos_theta * cos_theta, sin_sq = 1.0 - cos_sq;
  const double n_sq = index.n * index.n, k_sq = index.k * index.k;
  // With a + i b the complex cosine inside the metal times its index: modulus = a^2 + b^2, two_a_cos = 2 a cos_theta.
  const double t = n_sq - k_sq - sin_sq;
  const double modulus = std::sqrt(t * t + 4.0 * n_sq * k_sq);
  const double two_a_cos = 2.0 * cos_theta * std::sqrt(std::max(0.5 * (modulus + t), 0.0));
  const double perpendicular = (modulus + cos_sq - two_a_cos) / (modulus + cos_sq + two_a_cos);
  const double along = modulus * cos_sq + sin_sq * sin_sq, cross = two_a_cos * sin_sq;
  return 0.5 * perpendicular * (1.0 + (along - cross) / (along + cross));
}

Reflectance::Reflectance(const RefractiveIndex& index)
    : Reflectance(std::array{550.0}, std::array{index}) {}  // a spectrum is constant outside its samples

Reflectance::Reflectance(std::span<const double> wavelengths, std::span<const RefractiveIndex> indices) {
  const std::vector<Vec3d> weights = rec709_weights(wavelengths);
  std::vector<float> spectrum(indices.size());
  for (size_t node = 0; node <= kSteps; ++node) {
    const double cos_theta = static_cast<double>(node) / static_cast<double>(kSteps);
    std::transform(indices.begin(), indices.end(), spectrum.begin(), [&](const RefractiveIndex& index) {
      return static_cast<float>(fresnel_reflectance(index, cos_theta));
    });
    nodes_[node] = glm::clamp(rec709_of(weights, spectrum), 0.0f, 1.0f);
  }
}

}  // namespace velour
