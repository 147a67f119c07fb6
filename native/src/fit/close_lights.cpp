#include "fit/close_lights.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "fit/evaluate.h"
#include "sphere/directions.h"
#include "sphere/frame.h"

namespace velour {
namespace {

constexpr int kEvenLights = 4096, kRings = 72, kSpokes = 40;
constexpr double kInnerRadius = 1e-4;  // radians; a Gaussian of bandwidth 1e8 is as wide

/// Rings about an axis: the cap within kInnerRadius, then cells of equal width on a logarithmic scale.
class Rings {
 public:
  explicit Rings(const Vec3& axis) : axis_(axis), frame_(Frame::about(axis)) {}

  void append(std::vector<Vec3>& out) const {
    for (int i = 0; i < kRings; ++i) {
      const double angle = i == 0 ? kInnerRadius / std::sqrt(2.0) : std::sqrt(edge(i) * edge(i + 1));
      const double turn = 0.6180339887498949 * i;  // golden ratio: neighbouring rings do not line up
      for (int k = 0; k < kSpokes; ++k) {
        const double phi = 2 * kPiD * (k + turn) / kSpokes;
        const Vec3d local(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle));
        out.push_back(glm::normalize(frame_.to_world(Vec3(local))));
      }
    }
  }

  /// Directions per steradian at `w`.
  double density(const Vec3& w) const {
    const double angle = 2 * std::asin(std::min(1.0, 0.5 * glm::length(Vec3d(w) - Vec3d(axis_))));
    if (angle >= edge(kRings)) return 0;
    const double ring = angle < kInnerRadius ? 0 : 1 + std::log(angle / kInnerRadius) / log_step();
    const int i = std::min(static_cast<int>(ring), kRings - 1);
    const double inner = i == 0 ? 0 : edge(i), outer = edge(i + 1);
    // cos(inner) - cos(outer) without cancellation.
    return kSpokes / (4 * kPiD * std::sin(0.5 * (inner + outer)) * std::sin(0.5 * (outer - inner)));
  }

 private:
  static double log_step() { return std::log(0.5 * kPiD / kInnerRadius) / (kRings - 1); }
  /// Inner radius of ring i > 0, radians.
  static double edge(int i) { return kInnerRadius * std::exp((i - 1) * log_step()); }

  Vec3 axis_;
  Frame frame_;
};

constexpr int kOwnLights = 2048;

/// What the sampler draws from a rank-1 lattice.
void append_own(const Material& material, const PreparedBrdf& point, std::vector<Vec3>& out) {
  for (int i = 0; i < kOwnLights; ++i) {
    const double u = (i + 0.5) / kOwnLights, v = 0.6180339887498949 * i;
    out.push_back(material.sample_one(point, Vec2(u, v - std::floor(v))));
  }
}

}  // namespace

WeightedLights close_lights(const Material& material, const Vec3& wv) {
  const auto point = std::make_unique<PreparedBrdf>();
  material.prepare(wv, *point);
  const Rings mirror({-wv.x, -wv.y, wv.z}), retro(wv);
  std::vector<Vec3> all = hemisphere_fibonacci(kEvenLights);
  mirror.append(all);
  retro.append(all);
  const size_t not_own = all.size();
  append_own(material, *point, all);
  std::vector<float> own(all.size());
  evaluate(material, wv, all, {}, own);
  WeightedLights lights;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool drawn_with_density = i < not_own || own[i] > 0.0f;
    if (all[i].z <= 0 || !drawn_with_density) continue;
    lights.wl.push_back(all[i]);
    lights.weight.push_back(1 / (kEvenLights / (2 * kPiD) + mirror.density(all[i]) + retro.density(all[i]) +
                                 kOwnLights * static_cast<double>(own[i])));
  }
  return lights;
}

}  // namespace velour
