#include "brdf/fit/error/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include "brdf/fit/error/evaluate.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

constexpr int kParts = 256;                             // of the tree of a view
constexpr size_t kTreeLights = 1200, kOwnLights = 400;  // of a set
constexpr double kMinCovered = 1.0 / 64;                // less says nothing about a view
// Sets of directions of a view. Several azimuths know as much together with fewer each.
constexpr size_t kFirstSets = 4, kFirstAzimuthSets = 2, kMaxSets = 16;
constexpr double kKnown = 0.05, kKnownError = 1e-3;

std::string key_of(int degrees) { return std::to_string(degrees); }

/// One azimuth of a reported view.
class JudgedView {
 public:
  JudgedView(const Measurement& measurement, const Material& material, const Vec3& wv)
      : measurement_(measurement), material_(material), wv_(wv), tree_(reader_of(measurement, wv), wv, kParts) {}

  void judge(size_t sets, const Progress& progress) {
    while (sets_.size() < sets) {
      progress.check();
      const WeightedLights lights = error_lights(tree_, material_, wv_, sets_.size());
      const size_t n = lights.wl.size();
      std::vector<Rgb> measured(n), model(n);
      std::vector<uint8_t> valid(n);
      measurement_.eval(wv_, lights.wl, measured, valid);
      evaluate(material_, wv_, lights.wl, model);
      ViewError error;
      for (size_t i = 0; i < n; ++i) {
        all_ += lights.weight[i];
        if (valid[i]) error.add(lights.weight[i], measured[i], model[i], lights.wl[i].z);
      }
      sum_.add(error);
      sets_.push_back(error);
    }
  }

  double covered() const { return sum_.solid_angle() / all_; }
  const ViewError& sum() const { return sum_; }
  ErrorEstimate estimate() const { return error_estimate(sets_); }

 private:
  const Measurement& measurement_;
  const Material& material_;
  Vec3 wv_;
  DirectionTree tree_;
  std::vector<ViewError> sets_;
  ViewError sum_;
  double all_ = 0;  // solid angle of all directions
};

/// The error of a reported view; nothing if it is hardly covered.
struct ReportedView {
  std::optional<ErrorEstimate> estimate;
  ViewError sum;
};

/// Mean over the covered azimuths.
std::optional<ErrorEstimate> mean_of(std::span<const JudgedView> azimuths) {
  double error = 0, variance = 0, count = 0;
  for (const JudgedView& view : azimuths) {
    if (view.covered() < kMinCovered) continue;
    const ErrorEstimate e = view.estimate();
    error += e.error;
    variance += e.standard_error * e.standard_error;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return ErrorEstimate{error / count, std::sqrt(variance) / count};
}

bool is_known(const ErrorEstimate& e) { return e.standard_error <= kKnown * std::max(e.error, kKnownError); }

ReportedView table_error(const Measurement& measurement, const Material& material, int degrees,
                         const Progress& progress, Comparison& out) {
  std::vector<JudgedView> azimuths;
  for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
    azimuths.emplace_back(measurement, material, wv);
  }
  ReportedView view;
  for (size_t sets = azimuths.size() > 1 ? kFirstAzimuthSets : kFirstSets; sets <= kMaxSets; sets *= 2) {
    for (JudgedView& azimuth : azimuths) azimuth.judge(sets, progress);
    view.estimate = mean_of(azimuths);
    if (!view.estimate || is_known(*view.estimate)) break;
  }
  double covered = 0;
  for (const JudgedView& azimuth : azimuths) {
    view.sum.add(azimuth.sum());
    covered += azimuth.covered() / static_cast<double>(azimuths.size());
  }
  out.covered_share[degrees] = covered;
  return view;
}

ReportedView sample_error(const Measurement& measurement, const Material& material, int degrees,
                          const Progress& progress) {
  std::vector<ViewError> errors;
  ReportedView view;
  const auto samples = measurement.samples();
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i % 1024 == 0) progress.check();
    const IrregularSample& s = samples[i];
    if (!held_out_sample(i) || reported_view_of(s.wv) != degrees) continue;
    Rgb model;
    evaluate(material, s.wv, {&s.wl, 1}, {&model, 1});
    errors.emplace_back().add(1, s.f, model, s.wl.z);
    view.sum.add(errors.back());
  }
  if (!errors.empty()) view.estimate = error_estimate(errors);
  return view;
}

}  // namespace

ErrorEstimate error_estimate(std::span<const ViewError> sets) {
  ViewError sum;
  for (const ViewError& set : sets) sum.add(set);
  ErrorEstimate out{sum.relative_l2(), 0};
  if (!(sum.energy() > 0) || !(out.error > 0)) return out;
  const double ratio = out.error * out.error, count = static_cast<double>(sets.size());
  double variance = 0;
  for (const ViewError& set : sets) variance += set.beyond(ratio) * set.beyond(ratio);
  const double of_ratio = std::sqrt(variance * count / std::max(count - 1, 1.0)) / sum.energy();
  out.standard_error = of_ratio / (2 * out.error);
  return out;
}

Comparison compare(const Measurement& measurement, const Material& material, Progress& progress) {
  Comparison out;
  double weighted = 0, weights = 0, variance = 0, log_sq = 0, solid_angle = 0;
  int done = 0;
  for (const int degrees : kHeldOutViews) {
    ReportedView view;
    if (measurement.covers_view(static_cast<float>(radians_from(static_cast<double>(degrees))))) {
      view = measurement.samples().empty() ? table_error(measurement, material, degrees, progress, out)
                                           : sample_error(measurement, material, degrees, progress);
    }
    log_sq += view.sum.log_sq_sum();
    solid_angle += view.sum.solid_angle();
    out.samples += view.sum.count();
    std::optional<double>& error = out.by_view_angle[key_of(degrees)];
    std::optional<double>& standard_error = out.standard_error_by_view_angle[key_of(degrees)];
    if (view.estimate) {
      error = view.estimate->error;
      standard_error = view.estimate->standard_error;
      const double weight = std::cos(radians_from(static_cast<double>(degrees)));
      weighted += weight * *error;
      weights += weight;
      variance += weight * weight * *standard_error * *standard_error;
    }
    out.noise_by_view_angle[key_of(degrees)] = error ? noise_of_view(measurement, degrees, progress) : std::nullopt;
    progress.update(++done / static_cast<double>(kHeldOutViews.size()));
  }
  // If no view can be judged, an error of 1 is reported rather than a good one.
  out.relative_l2 = weights > 0 ? weighted / weights : 1.0;
  if (weights > 0) out.standard_error = std::sqrt(variance) / weights;
  if (solid_angle > 0) out.log_rms = std::sqrt(log_sq / solid_angle);
  return out;
}

WeightedLights error_lights(const DirectionTree& tree, const Material& material, const Vec3& wv, uint64_t set) {
  constexpr uint64_t kStream = 0x0e44;
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  std::vector<Vec3> all;
  tree.sample(kTreeLights, set, all);
  RandomStream random(set, kStream, 0);
  const auto turned = [](double x) { return x - std::floor(x); };
  const double shift = static_cast<double>(random.next()), turn = static_cast<double>(random.next());
  for (size_t i = 0; i < kOwnLights; ++i) {
    const auto at = static_cast<double>(i);
    all.push_back(point->sample_one(Vec2(turned((at + 0.5) / kOwnLights + shift), turned(kGoldenRatio * at + turn))));
  }
  std::vector<float> own(all.size());
  evaluate(material, wv, all, {}, own);
  WeightedLights lights;
  for (size_t i = 0; i < all.size(); ++i) {
    const bool sampled = i < kTreeLights || own[i] > 0.0f;
    if (all[i].z <= 0 || !sampled) continue;
    lights.wl.push_back(all[i]);
    lights.weight.push_back(1 / (kTreeLights * tree.density(all[i]) + kOwnLights * static_cast<double>(own[i])));
  }
  return lights;
}

namespace {

constexpr double kPairDistance = kPiD / 180;  // radians; maximum difference per angle of a pair of irregular samples

/// Sums over pairs of values that should be equal.
class PairNoise {
 public:
  void add(double weight, double a, double b) {
    difference_sq_ += 0.5 * weight * (a - b) * (a - b);
    energy_ += 0.5 * weight * (a * a + b * b);
  }
  std::optional<double> relative() const {
    if (!(energy_ > 0)) return std::nullopt;
    return std::sqrt(difference_sq_ / energy_);
  }

 private:
  double difference_sq_ = 0, energy_ = 0;
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
  const DirectionTree tree(reader_of(measurement, wv), wv, kParts);
  std::vector<Vec3> lights;
  tree.sample(kTreeLights, 0, lights);
  std::vector<Vec3> images(lights);
  for (Vec3& w : images) w = mirrored(w, wv);
  std::vector<Rgb> f(lights.size()), f_image(lights.size());
  std::vector<uint8_t> valid(lights.size()), valid_image(lights.size());
  measurement.eval(wv, lights, f, valid);
  measurement.eval(wv, images, f_image, valid_image);
  for (size_t i = 0; i < lights.size(); ++i) {
    if (i % 64 == 0) progress.check();
    if (!valid[i]) continue;
    const double cosine = lights[i].z, weight = 1 / tree.density(lights[i]);
    if (valid_image[i] && measurement.isotropic()) {
      mirror.add(weight, cosine * luminance(f[i]), cosine * luminance(f_image[i]));
    }
    Rgb swapped;
    uint8_t covered = 0;
    measurement.eval(lights[i], {&wv, 1}, {&swapped, 1}, {&covered, 1});
    if (covered) reciprocal.add(weight, cosine * luminance(f[i]), cosine * luminance(swapped));
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
        noise.add(1, samples[i].cosine * samples[i].f, samples[i].cosine * samples[j].f);
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
