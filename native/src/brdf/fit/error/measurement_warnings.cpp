#include "brdf/fit/error/measurement_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>
#include "brdf/fit/fit_report.h"
#include "brdf/measure/half_diff.h"
#include "brdf/measure/held_out.h"

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

}  // namespace velour
