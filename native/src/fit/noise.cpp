#include "fit/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fit/evaluate.h"
#include "sphere/directions.h"

namespace velour {
namespace {

constexpr int kNoiseLights = 4096;
constexpr double kPairDistance = kPiD / 180;  // radians; maximum difference per angle of a pair of irregular samples

/// Sums over pairs of values that should be equal.
class PairNoise {
 public:
  void add(double a, double b) {
    difference_sq_ += 0.5 * (a - b) * (a - b);
    energy_ += 0.5 * (a * a + b * b);
    ++count_;
  }
  std::optional<double> relative() const {
    if (count_ == 0 || !(energy_ > 0)) return std::nullopt;
    return std::sqrt(difference_sq_ / energy_);
  }

 private:
  double difference_sq_ = 0, energy_ = 0;
  uint64_t count_ = 0;
};

std::optional<double> larger(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a ? a : b;
  return std::max(*a, *b);
}

/// `w` mirrored about the plane of incidence of `wv`.
Vec3 mirrored(const Vec3& w, const Vec3& wv) {
  const float length = std::hypot(wv.x, wv.y);
  if (length == 0) return {w.x, -w.y, w.z};
  const Vec3 normal(-wv.y / length, wv.x / length, 0);
  return w - 2 * glm::dot(w, normal) * normal;
}

void add_table_pairs(const Measurement& measurement, const Vec3& wv, const Progress& progress, PairNoise& mirror,
                     PairNoise& reciprocal) {
  const std::vector<Vec3> lights = hemisphere_fibonacci(kNoiseLights);
  std::vector<Vec3> images(lights);
  for (Vec3& w : images) w = mirrored(w, wv);
  std::vector<Rgb> f(lights.size()), f_image(lights.size());
  std::vector<uint8_t> valid(lights.size()), valid_image(lights.size());
  measurement.eval(wv, lights, f, valid);
  measurement.eval(wv, images, f_image, valid_image);
  for (size_t i = 0; i < lights.size(); ++i) {
    if (i % 64 == 0) progress.check();
    if (!valid[i]) continue;
    const double cosine = lights[i].z;
    if (valid_image[i] && measurement.isotropic()) {
      mirror.add(cosine * luminance(f[i]), cosine * luminance(f_image[i]));
    }
    Rgb swapped;
    uint8_t covered = 0;
    measurement.eval(lights[i], {&wv, 1}, {&swapped, 1}, {&covered, 1});
    if (covered) reciprocal.add(cosine * luminance(f[i]), cosine * luminance(swapped));
  }
}

/// An isotropic sample reduced by both symmetries, mirroring and reciprocity.
struct ReducedSample {
  double larger, smaller, azimuth;  // polar angles and the difference of the azimuths in [0, pi]
  double f, cosine;                 // luminance, and the cosine that weights it
  int view;
};

std::vector<ReducedSample> reduced(std::span<const ScatteredSample> samples) {
  std::vector<ReducedSample> out;
  for (const ScatteredSample& s : samples) {
    const double theta_l = std::acos(std::clamp(s.wl.z, -1.0f, 1.0f)),
                 theta_v = std::acos(std::clamp(s.wv.z, -1.0f, 1.0f));
    const double turn = std::remainder(std::atan2(s.wl.y, s.wl.x) - std::atan2(s.wv.y, s.wv.x), 2 * kPiD);
    out.push_back({std::max(theta_l, theta_v), std::min(theta_l, theta_v), std::abs(turn), luminance(s.f), s.wl.z,
                   reported_view_of(s.wv)});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.larger < b.larger; });
  return out;
}

/// Azimuths are compared by their distance on the sphere.
bool is_pair(const ReducedSample& a, const ReducedSample& b) {
  return std::abs(a.smaller - b.smaller) <= kPairDistance &&
         std::sin(std::min(a.smaller, b.smaller)) * std::abs(a.azimuth - b.azimuth) <= kPairDistance;
}

std::optional<double> sample_noise(const Measurement& measurement, int degrees, const Progress& progress) {
  if (!measurement.isotropic()) return std::nullopt;
  const std::vector<ReducedSample> samples = reduced(measurement.samples());
  PairNoise noise;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i % 64 == 0) progress.check();
    if (samples[i].view != degrees) continue;
    for (size_t j = i + 1; j < samples.size() && samples[j].larger - samples[i].larger <= kPairDistance; ++j) {
      if (is_pair(samples[i], samples[j])) {
        noise.add(samples[i].cosine * samples[i].f, samples[i].cosine * samples[j].f);
      }
    }
  }
  return noise.relative();
}

}  // namespace

std::optional<double> noise_of_view(const Measurement& measurement, int degrees, const Progress& progress) {
  if (!measurement.samples().empty()) return sample_noise(measurement, degrees, progress);
  PairNoise mirror, reciprocal;
  for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
    add_table_pairs(measurement, wv, progress, mirror, reciprocal);
  }
  return larger(mirror.relative(), reciprocal.relative());
}

}  // namespace velour
