#include "brdf/fit/error/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/view_grid.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"

namespace velour {

namespace {

constexpr int kComparedLights = 4096;
constexpr uint64_t kMinLights = 64;  // minimum number of covered lights; fewer say nothing about a view
// Lights that capture less than half or more than twice the energy miss a highlight or take one direction for all of
// it. If fewer than two lights carry the captured energy, the error is that of a single direction.
constexpr double kEnergyFactor = 2, kMinCarriers = 2;
// For measured materials the error on close lights is 0.7 to 1.1 times that on even lights. Beyond these bounds a
// narrow lobe of the model falls between the even lights.
constexpr double kErrorFactor = 1.5, kErrorSum = 0.01;

std::string key_of(int degrees) { return std::to_string(degrees); }

/// Errors of one reported view, one entry per azimuth.
using AzimuthErrors = std::vector<ViewError>;

/// Mean over the azimuths with at least `least` directions; nothing if there are none.
std::optional<double> mean_error(const AzimuthErrors& errors, uint64_t least) {
  double sum = 0;
  int covered = 0;
  for (const ViewError& e : errors) {
    if (e.count() < least) continue;
    sum += e.relative_l2();
    ++covered;
  }
  return covered > 0 ? std::optional(sum / covered) : std::nullopt;
}

ViewError error_of_view(const Measurement& measurement, const Material& material, const Vec3& wv,
                        const WeightedLights& lights, Progress& progress) {
  const size_t n = lights.wl.size();
  std::vector<Rgb> measured(n), model(n);
  std::vector<uint8_t> valid(n);
  measurement.eval(wv, lights.wl, measured, valid);
  progress.check();
  evaluate(material, wv, lights.wl, model);
  ViewError error;
  for (size_t i = 0; i < n; ++i) {
    if (valid[i]) error.add(lights.weight[i], measured[i], model[i], lights.wl[i].z);
  }
  return error;
}

/// Errors of one reported view on even lights, or on close_lights() if the even ones misjudge energy or error. Writes
/// covered_share and narrow_views of `out`.
AzimuthErrors table_errors(const Measurement& measurement, const Material& material, int degrees, Progress& progress,
                           Comparison& out) {
  const WeightedLights even{hemisphere_fibonacci(kComparedLights),
                            std::vector<double>(kComparedLights, 2 * kPiD / kComparedLights)};
  AzimuthErrors errors, close_errors;
  double seen = 0, energy = 0, covered = 0, carriers = kComparedLights;
  for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
    errors.push_back(error_of_view(measurement, material, wv, even, progress));
    close_errors.push_back(error_of_view(measurement, material, wv, close_lights(material, wv), progress));
    covered += static_cast<double>(errors.back().count()) / kComparedLights;
    seen += errors.back().energy();
    carriers = std::min(carriers, errors.back().carriers());
    energy += close_errors.back().energy();
  }
  out.covered_share[degrees] = covered / static_cast<double>(errors.size());
  const bool even_see_all = seen * kEnergyFactor >= energy && seen <= kEnergyFactor * energy;
  const bool understated =
      mean_error(close_errors, 1).value_or(0) > kErrorFactor * mean_error(errors, 1).value_or(0) + kErrorSum;
  if (energy == 0 || (even_see_all && carriers >= kMinCarriers && !understated)) return errors;
  out.narrow_views[degrees] = seen / energy;
  return close_errors;
}

AzimuthErrors sample_errors(const Measurement& measurement, const Material& material, int degrees, Progress& progress) {
  ViewError error;
  const auto samples = measurement.samples();
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i % 1024 == 0) progress.check();
    const IrregularSample& s = samples[i];
    if (!held_out_sample(i) || reported_view_of(s.wv) != degrees) continue;
    Rgb model;
    evaluate(material, s.wv, {&s.wl, 1}, {&model, 1});
    error.add(1, s.f, model, s.wl.z);
  }
  return {error};
}

}  // namespace

Comparison compare(const Measurement& measurement, const Material& material, Progress& progress) {
  Comparison out;
  double weighted = 0, weights = 0, log_sq = 0;
  int done = 0;
  for (const int degrees : kHeldOutViews) {
    std::optional<double>& entry = out.by_view_angle[key_of(degrees)];
    if (measurement.covers_view(static_cast<float>(radians_from(static_cast<double>(degrees))))) {
      const bool irregular = !measurement.samples().empty();
      const auto errors = irregular ? sample_errors(measurement, material, degrees, progress)
                                    : table_errors(measurement, material, degrees, progress, out);
      entry = mean_error(errors, irregular ? 1 : kMinLights);
      if (!entry) out.narrow_views.erase(degrees);
      for (const ViewError& e : errors) {
        log_sq += e.log_sq_sum();
        out.samples += e.count();
      }
    }
    if (entry) {
      const double weight = std::cos(radians_from(static_cast<double>(degrees)));
      weighted += weight * *entry;
      weights += weight;
    }
    out.noise_by_view_angle[key_of(degrees)] = entry ? noise_of_view(measurement, degrees, progress) : std::nullopt;
    progress.update(++done / static_cast<double>(kHeldOutViews.size()));
  }
  // If no view can be judged, an error of 1 is reported rather than a good one.
  out.relative_l2 = weights > 0 ? weighted / weights : 1.0;
  if (out.samples > 0) out.log_rms = std::sqrt(log_sq / static_cast<double>(out.samples));
  return out;
}

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

std::vector<ReducedSample> reduced(std::span<const IrregularSample> samples) {
  std::vector<ReducedSample> out;
  for (const IrregularSample& s : samples) {
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

namespace {

constexpr double kInnerRadius = 1e-4;  // radians; the width of a Gaussian of bandwidth 1e8

CloseRings rings_about(const Vec3& axis, const LightCounts& counts) {
  return {axis, kInnerRadius, 0.5 * kPiD, counts.rings, counts.spokes};
}

/// Appends directions that the material's own sampler generates from a rank-1 lattice.
void append_own(const PreparedBrdf& point, int count, std::vector<Vec3>& out) {
  for (int i = 0; i < count; ++i) {
    const double u = (i + 0.5) / count, v = kGoldenRatio * i;
    out.push_back(point.sample_one(Vec2(u, v - std::floor(v))));
  }
}

}  // namespace

WeightedLights close_lights(const Material& material, const Vec3& wv, const LightCounts& counts) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  const CloseRings mirror = rings_about({-wv.x, -wv.y, wv.z}, counts), retro = rings_about(wv, counts);
  std::vector<Vec3> all = hemisphere_fibonacci(counts.even);
  mirror.append(all);
  retro.append(all);
  const size_t not_own = all.size();
  append_own(*point, counts.own, all);
  std::vector<float> own(all.size());
  evaluate(material, wv, all, {}, own);
  WeightedLights lights;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool drawn_with_density = i < not_own || own[i] > 0.0f;
    if (all[i].z <= 0 || !drawn_with_density) continue;
    lights.wl.push_back(all[i]);
    lights.weight.push_back(1 / (counts.even / (2 * kPiD) + mirror.density(all[i]) + retro.density(all[i]) +
                                 counts.own * static_cast<double>(own[i])));
  }
  return lights;
}

}  // namespace velour
