#include "brdf/fit/fit_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "brdf/fit/error/compare.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/slice_sampling.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"

namespace velour {

namespace {

constexpr double kManyInvalid = 0.1;  // share of the entries above the horizon
constexpr double kFewLights = 0.9;    // share of the hemisphere
constexpr size_t kFewSamples = 500;   // about 60 of them held out, a dozen per reported view
constexpr double kBrushed = 0.1;      // logarithm of a factor
constexpr double kDarkest = 0.001;    // albedo; black velvet and soot are brighter
constexpr double kBrokenReciprocity = 0.1;

void warn_of_entries(const Measurement& measurement, std::vector<Warning>& warnings) {
  const EntryCounts& n = measurement.counts();
  const uint64_t possible = n.valid + n.invalid();
  if (static_cast<double>(n.invalid()) > kManyInvalid * static_cast<double>(possible)) {
    warnings.push_back(warning<WarningCode::invalid_entries>({{"invalid", n.invalid()}, {"entries", possible}}));
  }
}

void warn_of_spikes(const EntryCounts& n, std::vector<Warning>& warnings) {
  if (n.spikes == 0) return;
  warnings.push_back(warning<WarningCode::spikes_left_out>({{"spikes", n.spikes}, {"samples", n.valid + n.spikes}}));
}

void warn_of_few_samples(size_t samples, bool all_data, std::vector<Warning>& warnings) {
  if (samples == 0 || samples >= kFewSamples) return;
  uint64_t judges = 0;
  for (uint64_t i = 0; i < samples; ++i) judges += held_out_sample(i);
  warnings.push_back(
      warning<WarningCode::few_samples>({{"samples", samples}, {"judged", judges}, {"held_out", !all_data}}));
}

void warn_of_azimuth(std::span<const IrregularSample> samples, std::vector<Warning>& warnings) {
  const std::optional<AzimuthSpread> spread = azimuth_spread(samples);
  if (!spread || spread->turned < kBrushed || spread->turned < 2 * spread->alike) return;
  warnings.push_back(warning<WarningCode::anisotropic_samples>({{"pairs", spread->turned_pairs},
                                                                {"factor", std::exp(spread->turned)},
                                                                {"same_azimuth_factor", std::exp(spread->alike)}}));
}

/// Names the view whose noise exceeds its tolerance by the largest factor.
void warn_of_noise(const Comparison& errors, double tolerance, std::vector<Warning>& warnings) {
  int worst = 0;
  uint64_t count = 0;
  double most = 1;
  for (const int degrees : kHeldOutViews) {
    const auto noise = errors.noise_by_view_angle.at(std::to_string(degrees));
    const double limit = tolerance_at(tolerance, radians_from(static_cast<double>(degrees)));
    if (!noise || *noise <= limit) continue;
    ++count;
    if (*noise / limit > most) most = *noise / limit, worst = degrees;
  }
  if (count == 0) return;
  warnings.push_back(warning<WarningCode::noise_exceeds_tolerance>(
      {{"count", count},
       {"worst", static_cast<double>(worst)},
       {"difference", *errors.noise_by_view_angle.at(std::to_string(worst))}}));
}

/// Views, in degrees, and the smallest of their shares.
struct Views {
  std::vector<double> degrees;
  double share = std::numeric_limits<double>::infinity();

  void add(int view, double value) {
    degrees.push_back(view);
    share = std::min(share, value);
  }
};

void warn_of_holes(const Comparison& errors, std::vector<Warning>& warnings) {
  Views views;
  for (const auto& [degrees, share] : errors.covered_share) {
    if (share < kFewLights && errors.by_view_angle.at(std::to_string(degrees))) views.add(degrees, share);
  }
  if (views.degrees.empty()) return;
  warnings.push_back(warning<WarningCode::partial_coverage>({{"views", views.degrees}, {"share", views.share}}));
}

void warn_of_nothing_to_judge(const Comparison& errors, std::vector<Warning>& warnings) {
  const bool judged = std::any_of(errors.by_view_angle.begin(), errors.by_view_angle.end(),
                                  [](const auto& entry) { return entry.second.has_value(); });
  if (!judged) warnings.push_back(warning<WarningCode::no_view_covered>());
}

void warn_of_darkness(double albedo, double error, std::vector<Warning>& warnings) {
  if (albedo == 0 && error > 0) {
    warnings.push_back(warning<WarningCode::black_model>());
  } else if (albedo == 0) {
    warnings.push_back(warning<WarningCode::black_measurement>());
  } else if (albedo < kDarkest) {
    warnings.push_back(warning<WarningCode::dark_measurement>({{"albedo", albedo}}));
  }
}

/// Compares with the model, since noise breaks the reciprocity of a measurement but hardly that of a smooth model.
bool is_not_reciprocal(const FitRecord& record) {
  const double measured = record.measured_reciprocity.value_or(0);
  return measured > kBrokenReciprocity && record.reciprocity > 0.5 * measured;
}

void warn_of_reciprocity(const FitRecord& record, std::vector<Warning>& warnings) {
  if (is_not_reciprocal(record)) {
    warnings.push_back(warning<WarningCode::measurement_not_reciprocal>({{"change", *record.measured_reciprocity}}));
  } else if (record.reciprocity > kBrokenReciprocity) {
    warnings.push_back(warning<WarningCode::model_not_reciprocal>({{"change", record.reciprocity}}));
  }
}

}  // namespace

void warn_of_measurement(const Measurement& measurement, const Comparison& errors, FitRecord& record) {
  warn_of_entries(measurement, record.warnings);
  warn_of_spikes(measurement.counts(), record.warnings);
  warn_of_few_samples(measurement.samples().size(), record.all_data, record.warnings);
  warn_of_azimuth(measurement.samples(), record.warnings);
  // Reciprocal pairs of a non-reciprocal measurement say nothing about its noise.
  if (!is_not_reciprocal(record)) warn_of_noise(errors, record.tolerance, record.warnings);
  warn_of_holes(errors, record.warnings);
  warn_of_nothing_to_judge(errors, record.warnings);
  warn_of_darkness(record.albedo_max, errors.relative_l2, record.warnings);
  warn_of_reciprocity(record, record.warnings);
}

namespace {

constexpr float kCell = radians_from(3.0f);
constexpr float kAlike = radians_from(15.0f), kTurned = radians_from(30.0f);
constexpr float kUpright = radians_from(5.0f);  // minimum polar angle of a half vector with a meaningful azimuth
constexpr size_t kFewest = 100;
constexpr size_t kMaxInCell = 64;  // the number of pairs grows with the square

struct Entry {
  uint64_t cell;
  float phi_h;  // modulo half a turn
  float log_f;
};

uint64_t cell_of(const HalfDiff& angles) {
  const auto part = [](float angle) { return static_cast<uint64_t>(angle / kCell); };
  return (part(angles.theta_h) * 64 + part(angles.theta_d)) * 64 + part(angles.phi_d);
}

/// Smallest angle between two azimuths modulo half a turn.
float between(float a, float b) {
  const float apart = std::fmod(std::abs(a - b), kPi);
  return std::min(apart, kPi - apart);
}

double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return double{*middle};
}

}  // namespace

std::optional<AzimuthSpread> azimuth_spread(std::span<const IrregularSample> samples) {
  std::vector<Entry> entries;
  for (const IrregularSample& s : samples) {
    const HalfDiff angles = half_diff(s.wl, s.wv);
    const float f = luminance(s.f);
    if (angles.theta_h < kUpright || !(f > 0.0f)) continue;
    entries.push_back({cell_of(angles), angles.phi_h, std::log(f)});
  }
  std::ranges::stable_sort(entries, {}, &Entry::cell);
  std::vector<float> alike, turned;
  for (size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].cell == entries[begin].cell) ++end;
    const size_t last = std::min(end, begin + kMaxInCell);
    for (size_t i = begin; i < last; ++i)
      for (size_t j = i + 1; j < last; ++j) {
        const Entry &a = entries[i], &b = entries[j];
        const float difference = std::abs(a.log_f - b.log_f), apart = between(a.phi_h, b.phi_h);
        if (apart <= kAlike) alike.push_back(difference);
        if (apart >= kTurned) turned.push_back(difference);
      }
  }
  if (alike.size() < kFewest || turned.size() < kFewest) return std::nullopt;
  return AzimuthSpread{median(alike), median(turned), turned.size()};
}

namespace {

// Albedo above which the scale must be wrong: no measurement error doubles the light of a perfect reflector.
constexpr double kWrongScale = 2;

double polar_degrees(const Vec3& w) { return std::acos(std::clamp(static_cast<double>(w.z), -1.0, 1.0)) * 180 / kPiD; }

/// The azimuth of a view for warnings; none for isotropic measurements, whose azimuths have no meaning.
std::vector<double> azimuth_degrees(const Vec3& wv, bool isotropic) {
  if (isotropic) return {};
  return {std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x)) * 180 / kPiD};
}

double largest(const Vec3d& v) { return std::max({v.x, v.y, v.z}); }

void warn_of_errors(const FitRecord& record, std::vector<Warning>& warnings) {
  std::vector<double> missed, errors, not_covered;
  for (const int degrees : kHeldOutViews) {
    const auto error = record.by_view_angle.at(std::to_string(degrees));
    if (!error) {
      not_covered.push_back(degrees);
    } else if (*error > tolerance_at(record.tolerance, radians_from(static_cast<double>(degrees)))) {
      missed.push_back(degrees);
      errors.push_back(*error);
    }
  }
  if (!missed.empty()) {
    warnings.push_back(warning<WarningCode::views_exceed_tolerance>(
        {{"views", missed}, {"errors", errors}, {"tolerance", record.tolerance}}));
  }
  if (!not_covered.empty()) warnings.push_back(warning<WarningCode::views_not_covered>({{"views", not_covered}}));
}

/// One warning for all fitted views beyond the tolerance, so that a difficult material does not bury other warnings.
void warn_of_fitted_views(const std::vector<FittedView>& fitted, const FitOptions& options, bool isotropic,
                          std::vector<Warning>& warnings) {
  constexpr size_t kMaxNamed = 12;
  std::vector<double> views, azimuths;
  size_t missed = 0;
  const FittedView* worst = nullptr;
  for (const FittedView& v : fitted) {
    if (v.relative_l2 <= tolerance_at(options.tolerance, std::acos(std::min(v.wv.z, 1.0f)))) continue;
    if (++missed <= kMaxNamed) {
      views.push_back(polar_degrees(v.wv));
      std::ranges::copy(azimuth_degrees(v.wv, isotropic), std::back_inserter(azimuths));
    }
    if (!worst || v.relative_l2 > worst->relative_l2) worst = &v;
  }
  if (!worst) return;
  warnings.push_back(
      warning<WarningCode::fitted_views_exceed_tolerance>({{"views", views},
                                                           {"azimuths", azimuths},
                                                           {"missed", missed},
                                                           {"fitted", fitted.size()},
                                                           {"lobes", static_cast<uint64_t>(options.max_lobes)},
                                                           {"worst", polar_degrees(worst->wv)},
                                                           {"worst_azimuth", azimuth_degrees(worst->wv, isotropic)},
                                                           {"error", worst->relative_l2},
                                                           {"tolerance", options.tolerance}}));
}

constexpr double kVisibleExcess = 0.005;  // of a model's albedo over 1

/// The largest albedo of the views that were added, and its view.
struct Brightest {
  double albedo = 0;
  Vec3 wv{0, 0, 1};

  void add(double other, const Vec3& view) {
    if (other > albedo) albedo = other, wv = view;
  }
};

void warn_of_albedo(const Measurement& measurement, const Brightest& measured, const Brightest& modeled,
                    std::vector<Warning>& warnings) {
  // Over the lights that the measurement covers: the measured albedos are lower bounds.
  const double measured_there = largest(directional_albedo(measurement, modeled.wv).albedo);
  const auto azimuth = [&](const Brightest& at) { return azimuth_degrees(at.wv, measurement.isotropic()); };
  if (measured.albedo > kWrongScale) {
    warnings.push_back(warning<WarningCode::implausible_albedo>(
        {{"albedo", measured.albedo}, {"view", polar_degrees(measured.wv)}, {"azimuth", azimuth(measured)}}));
  } else if (modeled.albedo > 1 && measured_there > 1) {
    warnings.push_back(warning<WarningCode::measured_albedo_above_one>(
        {{"albedo", measured.albedo}, {"view", polar_degrees(measured.wv)}, {"azimuth", azimuth(measured)}}));
  } else if (modeled.albedo > 1 + kVisibleExcess) {
    warnings.push_back(warning<WarningCode::model_albedo_above_one>({{"albedo", modeled.albedo},
                                                                     {"view", polar_degrees(modeled.wv)},
                                                                     {"azimuth", azimuth(modeled)},
                                                                     {"measured", measured_there}}));
  }
}

void add_albedos(const Measurement& measurement, const Material& material, const std::vector<FittedView>& fitted,
                 FitRecord& record, Progress& progress) {
  for (const int degrees : kHeldOutViews) {
    std::optional<double>& entry = record.albedo_by_view_angle[std::to_string(degrees)];
    if (!record.by_view_angle.at(std::to_string(degrees))) continue;
    double most = 0;
    for (const Vec3& wv : reported_views(degrees, measurement.isotropic())) {
      most = std::max(most, largest(directional_albedo(material, wv)));
    }
    entry = most;
  }
  Brightest measured, modeled;
  for (const FittedView& v : fitted) {
    progress.check();
    measured.add(largest(directional_albedo(measurement, v.wv).albedo), v.wv);
    modeled.add(largest(directional_albedo(material, v.wv)), v.wv);
  }
  record.albedo_max = modeled.albedo;
  warn_of_albedo(measurement, measured, modeled, record.warnings);
}

/// Removes the errors outside `views` and replaces the mean by that of the fitted views.
void forget_errors_outside(const ViewRange& views, const std::vector<FittedView>& fitted, FitRecord& record) {
  for (auto& [degrees, error] : record.by_view_angle) {
    if (!views.holds(radians_from(std::stod(degrees)))) error = std::nullopt;
  }
  double sum = 0, weight = 0;
  for (const FittedView& v : fitted) {
    sum += static_cast<double>(v.wv.z) * v.relative_l2;
    weight += static_cast<double>(v.wv.z);
  }
  record.relative_l2 = sum / std::max(weight, 1e-12);
}

}  // namespace

double tolerance_at(double tolerance, double theta_v) {
  return theta_v <= radians_from(75.0) + 1e-6 ? tolerance : 2 * tolerance;
}

FitRecord report_fit(const Measurement& measurement, const Material& material, const FitOptions& options,
                     const std::vector<FittedView>& fitted, const ViewRange& views, Progress& progress) {
  FitRecord record;
  record.tolerance = options.tolerance;
  record.seed = options.seed;
  record.all_data = options.all_data;
  const Comparison errors = compare(measurement, material, progress);
  record.relative_l2 = errors.relative_l2;
  record.by_view_angle = errors.by_view_angle;
  if (views.whole()) {
    warn_of_errors(record, record.warnings);
    warn_of_fitted_views(fitted, options, measurement.isotropic(), record.warnings);
  } else {
    forget_errors_outside(views, fitted, record);
  }
  add_albedos(measurement, material, fitted, record, progress);
  record.reciprocity = reciprocity_error(material, progress);
  record.measured_reciprocity = reciprocity_error(measurement, progress);
  if (views.whole()) warn_of_measurement(measurement, errors, record);
  return record;
}

namespace {

constexpr int kReciprocityViews = 16, kReciprocityRings = 32, kReciprocitySpokes = 16;

std::vector<Vec3> views(bool isotropic) {
  std::vector<Vec3> out = hemisphere_fibonacci(kReciprocityViews);
  if (!isotropic) return out;
  for (Vec3& v : out) v = Vec3(std::sqrt(1 - v.z * v.z), 0, v.z);
  return out;
}

/// `f(pair)` is the luminance, or nothing if the pair is not covered. Returns nothing if no pair is covered both ways.
template <class Luminance>
std::optional<double> error_of(bool isotropic, const Progress& progress, const Luminance& f) {
  double difference = 0, energy = 0;
  bool covered = false;
  for (const Vec3& wv : views(isotropic)) {
    progress.check();
    const LightGrid lights = light_grid(wv, kReciprocityRings, kReciprocitySpokes);
    for (size_t i = 0; i < lights.wl.size(); ++i) {
      const Vec3& wl = lights.wl[i];
      const std::optional<double> there = f({wl, wv}), back = f({wv, wl});
      if (!there || !back) continue;
      covered = true;
      const double cosines = static_cast<double>(wl.z) * wv.z;
      const double a = *there * cosines, b = *back * cosines;
      difference += lights.weight[i] * (a - b) * (a - b);
      energy += lights.weight[i] * 0.5 * (a * a + b * b);
    }
  }
  if (!covered) return std::nullopt;
  return energy > 0 ? std::sqrt(difference / energy) : 0.0;
}

}  // namespace

double reciprocity_error(const Material& material, const Progress& progress) {
  const auto f = [&](const DirectionPair& pair) -> std::optional<double> {
    Rgb value;
    evaluate(material, pair.wv, {&pair.wl, 1}, {&value, 1});
    return luminance(value);
  };
  return error_of(material.isotropic(), progress, f).value_or(0);
}

std::optional<double> reciprocity_error(const Measurement& measurement, const Progress& progress) {
  if (!measurement.samples().empty()) return std::nullopt;
  const auto f = [&](const DirectionPair& pair) -> std::optional<double> {
    Rgb value;
    uint8_t valid = 0;
    measurement.eval(pair.wv, {&pair.wl, 1}, {&value, 1}, {&valid, 1});
    return valid ? std::optional<double>(luminance(value)) : std::nullopt;
  };
  return error_of(measurement.isotropic(), progress, f);
}

}  // namespace velour
