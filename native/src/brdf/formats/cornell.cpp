#include "brdf/formats/cornell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/text_number.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/held_out.h"
#include "brdf/measure/irregular_samples.h"
#include "brdf/measure/measurement.h"
#include "brdf/measure/spectrum.h"

namespace velour {
namespace {

/// Fine enough that the table adds less than the interpolation's own error.
constexpr BrdfTableLayout kCornellLayout{.theta_h = 90, .phi_h = 1, .theta_d = 60, .phi_d = 60};
constexpr double kMaxWavelengths = 10000;
constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";

/// Reads the numbers of a text one by one; skips comments.
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : text_(text), rest_(text) {
    if (rest_.starts_with(kUtf8Mark)) rest_.remove_prefix(kUtf8Mark.size());
  }

  enum class Result { number, end, not_a_number };

  Result next(double& value) {
    skip_to_number();
    if (rest_.empty()) return Result::end;
    const auto number = leading_number(rest_);
    if (!number || !is_end_of_number(number->length)) return Result::not_a_number;
    value = number->value;
    rest_.remove_prefix(number->length);
    return Result::number;
  }

  /// The word at the cursor, shortened for a message.
  std::string_view word() const {
    const std::string_view begin = rest_.substr(0, 20);
    return begin.substr(0, begin.find_first_of(kSpace));
  }

  /// The line of the cursor, from 1.
  size_t line() const {
    size_t line = 1;
    for (const char* c = text_.data(); c < rest_.data(); ++c) line += *c == '\n' || (*c == '\r' && c[1] != '\n');
    return line;
  }

 private:
  static constexpr std::string_view kSpace = " \t\n\v\f\r";

  bool is_end_of_number(size_t at) const {
    return at == rest_.size() || rest_[at] == '#' || kSpace.find(rest_[at]) != std::string_view::npos;
  }
  void skip_to_number() {
    while (true) {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpace), rest_.size()));
      if (!rest_.starts_with('#')) return;
      rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
    }
  }

  std::string_view text_, rest_;
};

std::string_view text_of(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw Error(Status::bad_data, path + ": " + what);
}

std::vector<double> read_numbers(std::span<const uint8_t> bytes, const std::string& path, const Progress& progress) {
  constexpr size_t kBetweenChecks = 1 << 16;
  NumberReader in(text_of(bytes));
  std::vector<double> numbers;
  for (double value = 0;;) {
    if (numbers.size() % kBetweenChecks == 0) progress.check();
    const auto result = in.next(value);
    if (result == NumberReader::Result::end) return numbers;
    if (result == NumberReader::Result::not_a_number)
      fail(path, "line " + std::to_string(in.line()) + " has '" + std::string(in.word()) +
                     "' where a number is expected; write numbers as 0.17 or 1.7e-1, separated by blanks.");
    numbers.push_back(value);
  }
}

bool is_count(double value) { return value >= 1 && value <= kMaxWavelengths && value == std::floor(value); }

struct CornellText {
  std::span<const double> wavelengths;  // nm
  std::span<const double> rows;         // theta_i, phi_i, theta_s, phi_s, then one value per wavelength
  size_t row_size = 0;
};

CornellText split(std::span<const double> numbers, const std::string& path) {
  if (numbers.empty() || !is_count(numbers[0]))
    fail(path, "number of wavelengths is " + (numbers.empty() ? "missing" : std::to_string(numbers[0])) +
                   "; it must be 1 to 10000.");
  const auto count = static_cast<size_t>(numbers[0]);
  if (numbers.size() < 1 + count)
    fail(path, "has " + std::to_string(numbers.size() - 1) + " of " + std::to_string(count) +
                   " wavelengths; the file is truncated.");
  const CornellText text{numbers.subspan(1, count), numbers.subspan(1 + count), 4 + count};
  check_wavelengths(text.wavelengths, path + ": wavelengths");
  if (text.rows.size() % text.row_size != 0)
    fail(path, "sample " + std::to_string(text.rows.size() / text.row_size + 1) + " has " +
                   std::to_string(text.rows.size() % text.row_size) + " of " + std::to_string(text.row_size) +
                   " numbers; the file is truncated or damaged.");
  return text;
}

/// False if an angle is not finite. Throws if a polar angle is outside [0, pi].
bool read_directions(std::span<const double> row, size_t index, const std::string& path, IrregularSample& sample) {
  for (const size_t i : {0u, 2u}) {
    if (row[i] < 0.0 || row[i] > kPiD)
      fail(path, "theta of sample " + std::to_string(index + 1) + " is " + std::to_string(row[i]) +
                     "; it must be 0 to pi radians.");
  }
  std::array<float, 4> angles;
  std::transform(row.begin(), row.begin() + 4, angles.begin(), [](double v) { return static_cast<float>(v); });
  if (!std::ranges::all_of(angles, [](float angle) { return std::isfinite(angle); })) return false;
  sample.wl = direction(angles[0], angles[1]);
  sample.wv = direction(angles[2], angles[3]);
  return true;
}

std::vector<IrregularSample> read_samples(const CornellText& text, const std::string& path, EntryCounts& counts) {
  const auto weights = rec709_weights(text.wavelengths);
  std::vector<IrregularSample> samples;
  std::vector<float> spectrum(text.wavelengths.size());
  for (size_t i = 0; i * text.row_size < text.rows.size(); ++i) {
    const auto row = text.rows.subspan(i * text.row_size, text.row_size);
    IrregularSample sample;
    if (!read_directions(row, i, path, sample)) {
      count_entry(Rgb(NAN), NegativeRule::luminance, counts);
      continue;
    }
    if (sample.wl.z <= 0.0f || sample.wv.z <= 0.0f) {
      count_below_horizon(counts);
      continue;
    }
    std::transform(row.begin() + 4, row.end(), spectrum.begin(), [](double v) { return static_cast<float>(v); });
    sample.f = rec709_of(weights, spectrum);
    if (count_entry(sample.f, NegativeRule::luminance, counts)) samples.push_back(sample);
  }
  return samples;
}

/// The interpolation of `samples` as a table. Throws Error(bad_data) if there are too few.
HalfDiffTable tabulated(std::span<const IrregularSample> samples, const std::string& path, const Progress& progress) {
  if (samples.size() < IrregularInterpolant::kNeighbors)
    fail(path, "has " + std::to_string(samples.size()) + " valid samples; at least " +
                   std::to_string(IrregularInterpolant::kNeighbors) + " are needed to interpolate.");
  return {kCornellLayout, resample_irregular(IrregularInterpolant(samples), kCornellLayout, progress)};
}

/// A table for eval; the samples themselves for the error of a fit.
class IrregularMeasurement : public TableMeasurement {
 public:
  IrregularMeasurement(std::vector<IrregularSample> samples, Provenance provenance, const EntryCounts& counts,
                       Details details, const Progress& progress)
      : TableMeasurement(tabulated(samples, provenance.path, progress), provenance, counts, std::move(details)),
        samples_(std::move(samples)) {
    for (const IrregularSample& sample : samples_) lowest_ = std::min({lowest_, sample.wl.z, sample.wv.z});
  }

  std::span<const IrregularSample> samples() const override { return samples_; }

  std::shared_ptr<const Measurement> without_held_out(const Progress& progress) const override {
    std::vector<IrregularSample> kept;
    for (size_t i = 0; i < samples_.size(); ++i) {
      if (!held_out_sample(i)) kept.push_back(samples_[i]);
    }
    if (kept.size() < IrregularInterpolant::kNeighbors)
      fail(provenance().path, "has " + std::to_string(samples_.size()) + " valid samples, of which " +
                                  std::to_string(kept.size()) +
                                  " remain when one in eight is held out to measure the error; at least " +
                                  std::to_string(IrregularInterpolant::kNeighbors) +
                                  " are needed. Measure more directions, or fit all data.");
    return std::make_shared<IrregularMeasurement>(std::move(kept), provenance(), counts(), details(), progress);
  }

  /// Below the lowest direction of any sample the interpolation only extrapolates, so a view there is not covered.
  bool covers_view(float theta_v) const override {
    constexpr float kTolerance = 1e-3f;  // of the cosine
    return std::cos(theta_v) >= lowest_ - kTolerance && TableMeasurement::covers_view(theta_v);
  }

 private:
  std::vector<IrregularSample> samples_;
  float lowest_ = 1.0f;
};

TableMeasurement::Details describe(const CornellText& text) {
  const auto whole = [](double v) { return std::to_string(std::lround(v)); };
  return {{"table", std::to_string(text.rows.size() / text.row_size) + " irregular samples of " +
                        std::to_string(text.wavelengths.size()) + " wavelengths, " + whole(text.wavelengths.front()) +
                        " to " + whole(text.wavelengths.back()) + " nm"},
          {"holds", "f without cosine, 1/sr, spectral; converted to linear Rec. 709 with the CIE 1931 observer"},
          {"invalid", "samples that are not finite or have negative luminance"},
          {"interpolation",
           "microfacet lobes, and local linear regression over 16 samples of what they leave, tabulated at " +
               std::to_string(kCornellLayout.theta_h) + " x " + std::to_string(kCornellLayout.theta_d) + " x " +
               std::to_string(kCornellLayout.phi_d) + " nodes"}};
}

/// The comment lines before the first number, as the file's description.
std::string opening_comment(std::span<const uint8_t> bytes) {
  constexpr size_t kLimit = 1000;
  std::string_view text = text_of(bytes);
  if (text.starts_with(kUtf8Mark)) text.remove_prefix(kUtf8Mark.size());
  std::string comment;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.empty() || text[0] != '#' || comment.size() > kLimit) return comment;
    const auto line = text.substr(0, text.find_first_of("\r\n"));
    const auto words = line.substr(std::min(line.find_first_not_of("# \t"), line.size()));
    comment.append(comment.empty() ? "" : " ").append(words.substr(0, kLimit));
    text.remove_prefix(line.size());
  }
}

}  // namespace

bool looks_like_cornell(std::string_view head) {
  const auto is_binary = [](unsigned char c) { return c < ' ' && !(c >= '\t' && c <= '\r'); };
  if (std::ranges::any_of(head, is_binary)) return false;
  NumberReader in(head);
  double count = 0, wavelength = 0;
  return in.next(count) == NumberReader::Result::number && is_count(count) &&
         in.next(wavelength) == NumberReader::Result::number && wavelength >= 100 && wavelength <= 5000;
}

std::shared_ptr<const Measurement> read_cornell(std::span<const uint8_t> bytes, Provenance provenance,
                                                const Progress& progress) {
  const std::string path = provenance.path;
  const auto numbers = read_numbers(bytes, path, progress);
  const CornellText text = split(numbers, path);
  EntryCounts counts;
  auto samples = without_spikes(read_samples(text, path, counts));
  counts.spikes = counts.valid - samples.size();
  counts.valid = samples.size();
  provenance.format = "cornell";
  provenance.description = opening_comment(bytes);
  return std::make_shared<IrregularMeasurement>(std::move(samples), std::move(provenance), counts, describe(text),
                                                progress);
}

}  // namespace velour
