#include "brdf/fit/parametric/sample_spacing.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr float kNone = 1e30f;
constexpr double kWideEnough = -100;  // excess of lobes that are wide enough
constexpr double kMinCenterCosine = 1e-3;

/// Light direction at the center of the lobe. Half vectors that face away from the view have none, so their cosine with
/// it is clamped.
Vec3d light_at_center(const WarpedLobe& lobe, const Vec3d& wv) {
  const Vec3d center = argument_at(lobe, lobe.center);
  if (lobe.space == LobeSpace::light) return center;
  return 2 * std::max(glm::dot(center, wv), kMinCenterCosine) * center - wv;
}

WarpedLobe lobe_of(const WarpedShape& s) {
  return {s.space, stretch_from(s.stretch_a, s.stretch_b), tilted_normal(s.tilt_x, s.tilt_y),
          std::exp(s.log_bandwidth)};
}

Vec3d horizon_under(const Vec3d& wl) {
  const double length = std::hypot(wl.x, wl.y);
  return length > 0 ? Vec3d(wl.x / length, wl.y / length, 0) : Vec3d(1, 0, 0);
}

}  // namespace

SampleSpacing::SampleSpacing(std::span<const SliceSample> samples, const Vec3d& wv) : wv_(wv), empty_(samples.empty()) {
  log_cell_.fill(kNone);
  for (const SliceSample& s : samples) {
    const glm::dvec2 place = place_of(Vec3d(s.wl));
    const auto cell = [](double t) { return std::clamp(static_cast<int>(t), 0, kSide - 1); };
    float& least = log_cell_[static_cast<size_t>(cell(place.y) * kSide + cell(place.x))];
    least = std::min(least, std::log(s.weight));
  }
  spread();
}

/// Position on the disk, in cells.
glm::dvec2 SampleSpacing::place_of(const Vec3d& wl) {
  // Lambert's disk, folded: a slice of isotropic data may have only one side of the plane of incidence.
  const double scale = 1 / std::sqrt(1 + std::max(wl.z, 0.0));
  return {kSide * (0.5 + 0.5 * wl.x * scale), kSide * (0.5 + 0.5 * std::abs(wl.y) * scale)};
}

/// Takes the minimum over neighbors, because lobes reach into adjacent cells, until no cell is empty.
void SampleSpacing::spread() {
  for (bool first = true, gaps = !empty_; first || gaps; first = false) {
    const Cells before = log_cell_;
    gaps = false;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        float& cell = log_cell_[static_cast<size_t>(y * kSide + x)];
        if (!first && cell < kNone) continue;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kSide - 1); ++v) {
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kSide - 1); ++u) {
            cell = std::min(cell, before[static_cast<size_t>(v * kSide + u)]);
          }
        }
        gaps = gaps || (!empty_ && cell >= kNone);
      }
    }
  }
}

double SampleSpacing::log_solid_angle(const Vec3d& wl) const {
  const glm::dvec2 place = glm::clamp(place_of(wl) - 0.5, 0.0, kSide - 1.0);
  const int x = std::min(static_cast<int>(place.x), kSide - 2), y = std::min(static_cast<int>(place.y), kSide - 2);
  const auto cell = [&](int u, int v) { return static_cast<double>(log_cell_[static_cast<size_t>(v * kSide + u)]); };
  return std::lerp(std::lerp(cell(x, y), cell(x + 1, y), place.x - x),
                   std::lerp(cell(x, y + 1), cell(x + 1, y + 1), place.x - x), place.y - y);
}

/// Decrease of the logarithm of the lobe from the horizon upwards, per radian.
double SampleSpacing::steepness(const WarpedLobe& lobe, const Vec3d& at) const {
  constexpr double kStep = 1e-4;
  const Vec3d above = glm::normalize(at + Vec3d(0, 0, kStep));
  return lobe.bandwidth * glm::dot(warped(lobe, at, wv_) - warped(lobe, above, wv_), lobe.center) / kStep;
}

double SampleSpacing::excess(const WarpedShape& shape) const {
  if (empty_) return kWideEnough;
  const WarpedLobe lobe = lobe_of(shape);
  const Vec3d center = light_at_center(lobe, wv_);
  const double narrow = std::log(lobe.bandwidth * warp_jacobian(lobe, center, wv_) / (2 * kPiD));
  if (center.z >= 0) return narrow + log_solid_angle(center);
  const Vec3d seen = horizon_under(center);
  const double sample = log_solid_angle(seen), steep = steepness(lobe, seen);
  return std::max(narrow + sample, steep > 0 ? std::log(0.5 * steep) + 0.5 * sample : kWideEnough);
}

void SampleSpacing::slopes(const WarpedShape& shape, Eigen::Ref<Eigen::VectorXd> out) const {
  constexpr double WarpedShape::*kParameter[kWarpedSlopes] = {&WarpedShape::log_bandwidth, &WarpedShape::tilt_x,
                                                              &WarpedShape::stretch_a, &WarpedShape::tilt_y,
                                                              &WarpedShape::stretch_b};
  constexpr double kStep = 1e-5;
  for (Eigen::Index a = 0; a < out.size(); ++a) {
    WarpedShape more = shape, less = shape;
    more.*kParameter[a] += kStep;
    less.*kParameter[a] -= kStep;
    out[a] = (excess(more) - excess(less)) / (2 * kStep);
  }
}

}  // namespace velour
