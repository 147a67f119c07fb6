#include "fit/sample_spacing.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr float kNone = 1e30f;
constexpr double kAnyBandwidth = 100;  // its logarithm

}  // namespace

SampleSpacing::SampleSpacing(std::span<const SliceSample> samples, const Vec3d& wv) : wv_(wv) {
  Cells finest;
  finest.fill(kNone);
  for (const SliceSample& s : samples) {
    float& least = finest[cell_of(Vec3d(s.wl))];
    least = std::min(least, s.weight);
  }
  spread(finest);
}

size_t SampleSpacing::cell_of(const Vec3d& wl) {
  // Lambert's disk. A slice of isotropic data may hold one side of the plane of incidence only.
  const double scale = 1 / std::sqrt(1 + std::max(wl.z, 0.0));
  const auto place = [](double t) { return std::clamp(static_cast<int>((0.5 + 0.5 * t) * kSide), 0, kSide - 1); };
  return static_cast<size_t>(place(std::abs(wl.y) * scale) * kSide + place(wl.x * scale));
}

/// A lobe at the edge of a cell reaches into the next.
void SampleSpacing::spread(const Cells& finest) {
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      float least = kNone;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kSide - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kSide - 1); ++u) {
          least = std::min(least, finest[static_cast<size_t>(v * kSide + u)]);
        }
      }
      cell_[static_cast<size_t>(y * kSide + x)] = least;
    }
  }
}

double SampleSpacing::most_log_bandwidth(LobeSpace space, const Vec3d& center) const {
  Vec3d wl = center;
  double lights = 1;  // steradians of light directions per steradian of the lobe's space
  if (space == LobeSpace::half) {
    const double cosine = std::max(glm::dot(wv_, center), 1e-3);
    wl = 2 * cosine * center - wv_;
    lights = 4 * cosine;
  }
  const float solid_angle = wl.z > 0 ? cell_[cell_of(wl)] : kNone;
  if (solid_angle >= kNone) return kAnyBandwidth;
  return std::log(2 * kPiD * lights / static_cast<double>(solid_angle));
}

}  // namespace velour
