#include "btf/fit/size_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

namespace velour {

namespace {

constexpr size_t kMaxFits = 6;
constexpr double kClose = 0.03;    // relative to the tolerance or the size: close enough to stop
constexpr double kMinSlope = 0.1;  // slope of error over size, in logarithms
constexpr double kFarthest = 2;    // maximum step of an extrapolation, relative to the size of the fit that failed

/// Keeps logarithms finite for exact models.
double positive(double error) { return std::max(error, 1e-12); }

}  // namespace

SizeSearch::SizeSearch(const OrderCurve& curve, size_t largest, double tolerance)
    : curve_(curve), largest_(largest), tolerance_(tolerance) {}

void SizeSearch::add(size_t point, double error) { fits_.push_back({point, error}); }

std::optional<size_t> SizeSearch::next() const {
  if (fits_.empty()) return tolerance_ > 0 ? smallest_within(tolerance_) : largest_;
  if (tolerance_ == 0 || fits_.size() >= kMaxFits) return std::nullopt;
  const auto failing = largest_failing(), holding = smallest_holding();
  if (holding && (holding->point == 0 || holding->error >= (1 - kClose) * tolerance_)) return std::nullopt;
  size_t point = 0;
  if (failing && holding) {
    if (static_cast<double>(holding->point - failing->point) <= 1 + kClose * static_cast<double>(holding->point)) {
      return std::nullopt;
    }
    point = between(*failing, *holding);
  } else if (holding) {
    point = std::min(smallest_within(tolerance_ / height(holding->point)), holding->point - 1);
  } else {
    if (failing->point >= largest_) return std::nullopt;
    point = std::clamp(beyond(*failing), failing->point + 1, largest_);
  }
  return was_fitted(point) ? std::nullopt : std::optional(point);
}

bool SizeSearch::was_fitted(size_t point) const {
  return std::any_of(fits_.begin(), fits_.end(), [&](const Fit& fit) { return fit.point == point; });
}

std::optional<SizeSearch::Fit> SizeSearch::smallest_holding() const {
  std::optional<Fit> found;
  for (const Fit& fit : fits_) {
    if (holds(fit) && (!found || fit.point < found->point)) found = fit;
  }
  return found;
}

/// Considers only fits smaller than the smallest that holds: more bytes are not always better.
std::optional<SizeSearch::Fit> SizeSearch::largest_failing() const {
  const auto holding = smallest_holding();
  std::optional<Fit> found;
  for (const Fit& fit : fits_) {
    const bool smaller = !holding || fit.point < holding->point;
    if (!holds(fit) && smaller && (!found || fit.point > found->point)) found = fit;
  }
  return found;
}

size_t SizeSearch::smallest_within(double error) const {
  size_t point = 0;
  while (point < largest_ && expected(point) > error) ++point;
  return point;
}

size_t SizeSearch::between(const Fit& failing, const Fit& holding) const {
  const double above = std::log(positive(failing.error)), below = std::log(positive(holding.error));
  const double share = above > below ? (above - std::log(tolerance_)) / (above - below) : 0.5;
  const double error = std::exp(
      std::lerp(std::log(positive(expected(failing.point))), std::log(positive(expected(holding.point))), share));
  return std::clamp(smallest_within(error), failing.point + 1, holding.point - 1);
}

/// Extrapolates from the height of the largest failing fit and, if two fail, also along the line through them in
/// logarithms: noise and effects that the model cannot represent make errors fall more slowly than expected.
size_t SizeSearch::beyond(const Fit& failing) const {
  const size_t by_height = smallest_within(tolerance_ / height(failing.point));
  std::optional<Fit> before;
  for (const Fit& fit : fits_) {
    if (fit.point < failing.point && (!before || fit.point > before->point)) before = fit;
  }
  if (!before) return by_height;
  const auto size = [](const Fit& fit) { return std::log(static_cast<double>(fit.point) + 1); };
  const double slope = std::log(positive(before->error) / positive(failing.error)) / (size(failing) - size(*before));
  const double by_line = size(failing) + std::log(failing.error / tolerance_) / std::max(slope, kMinSlope);
  const double most = std::min(size(failing) + std::log(kFarthest), std::log(static_cast<double>(largest_) + 1));
  return std::max(by_height, static_cast<size_t>(std::exp(std::min(by_line, most))) - 1);
}

const SizeSearch::Fit& SizeSearch::best_fit() const {
  const auto better = [&](const Fit& a, const Fit& b) {
    if (holds(a) != holds(b)) return holds(a);
    return holds(a) ? a.point < b.point : a.error < b.error;
  };
  return *std::min_element(fits_.begin(), fits_.end(), better);
}

size_t SizeSearch::best() const { return best_fit().point; }

bool SizeSearch::met() const { return tolerance_ == 0 || holds(best_fit()); }

/// Ratio of measured to expected error, interpolated between fits and constant beyond the first and the last.
double SizeSearch::height(size_t point) const {
  const Fit *before = nullptr, *after = nullptr;
  for (const Fit& fit : fits_) {
    if (fit.point <= point && (!before || fit.point > before->point)) before = &fit;
    if (fit.point >= point && (!after || fit.point < after->point)) after = &fit;
  }
  const auto at = [&](const Fit& fit) { return std::log(positive(fit.error) / positive(expected(fit.point))); };
  if (!before || !after) return std::exp(at(before ? *before : *after));
  if (before->point == after->point) return std::exp(at(*before));
  const auto place = [](size_t p) { return std::log(static_cast<double>(p) + 1); };
  const double share = (place(point) - place(before->point)) / (place(after->point) - place(before->point));
  return std::exp(std::lerp(at(*before), at(*after), share));
}

std::vector<SizeTrial> SizeSearch::trials() const {
  std::vector<SizeTrial> trials;
  for (const Fit& fit : fits_) {
    const OrderPoint& point = curve_.points[fit.point];
    trials.push_back({point.lobes, point.parameter_bytes, point.relative_l2, fit.error});
  }
  return trials;
}

OrderCurve SizeSearch::measured_curve(size_t most) const {
  std::set<size_t> numbers;
  for (const Fit& fit : fits_) numbers.insert(fit.point);
  const auto all = static_cast<double>(curve_.points.size());
  for (size_t i = 0; i < most; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(most - 1);
    numbers.insert(std::min(curve_.points.size() - 1, static_cast<size_t>(std::pow(all, share) + 0.5) - 1));
  }
  OrderCurve curve;
  for (const size_t number : numbers) {
    OrderPoint point = curve_.points[number];
    point.relative_l2 *= height(number);
    for (const Fit& fit : fits_) {
      if (fit.point == number) point.relative_l2 = fit.error;
    }
    point.worst = tolerance_ > 0 ? point.relative_l2 / tolerance_ : point.relative_l2;
    if (number == best()) curve.chosen = curve.points.size();
    curve.points.push_back(point);
  }
  return curve;
}

Warning SizeSearch::shortfall() const {
  const Fit& closest = best_fit();
  const uint64_t bytes = curve_.points[closest.point].parameter_bytes;
  for (size_t point = largest_ + 1; point < curve_.points.size(); ++point) {
    if (expected(point) * height(point) > tolerance_) continue;
    return warning<WarningCode::tolerance_needs_bytes>({{"tolerance", tolerance_},
                                                        {"error", closest.error},
                                                        {"bytes", bytes},
                                                        {"enough", curve_.points[point].parameter_bytes}});
  }
  const double reachable = closest.error * (1 + kClose);
  if (largest_ + 1 < curve_.points.size()) {
    return warning<WarningCode::tolerance_needs_more_bytes>({{"tolerance", tolerance_},
                                                             {"error", closest.error},
                                                             {"bytes", bytes},
                                                             {"largest", curve_.points.back().parameter_bytes},
                                                             {"reachable", reachable}});
  }
  return warning<WarningCode::tolerance_out_of_reach>(
      {{"tolerance", tolerance_}, {"error", closest.error}, {"bytes", bytes}, {"reachable", reachable}});
}

namespace {

constexpr size_t kCurvePoints = 40;  // stored per curve
constexpr double kTrialFit = 0.85;   // fraction of a trial's progress; the rest is for measuring

std::string stage_of(size_t point) { return "fit." + std::to_string(point) + ".errors"; }

std::optional<BtfErrors> kept_errors(const FitCheckpoint& checkpoint, size_t point) {
  const auto kept = checkpoint.numbers(stage_of(point), 5);
  if (!kept || kept->size() != 5 || !((*kept)[2] >= 0)) return std::nullopt;
  return BtfErrors{(*kept)[0], (*kept)[1], (*kept)[2], (*kept)[3], static_cast<uint64_t>(std::max(0.0, (*kept)[4]))};
}

void keep_errors(FitCheckpoint& checkpoint, size_t point, const BtfErrors& errors) {
  const double numbers[] = {errors.psnr, errors.ser, errors.relative_l2, errors.brightness,
                            static_cast<double>(errors.pairs)};
  checkpoint.keep_numbers(stage_of(point), numbers);
  checkpoint.write();
}

/// Runs the fits of a search and holds the model of the best one.
class Trials {
 public:
  Trials(BtfFitter& fitter, const ErrorsOf& errors_of, const SizedFitOptions& options, Progress& progress)
      : fitter_(fitter),
        errors_of_(errors_of),
        options_(options),
        progress_(progress),
        search_(fitter.curve(), fitter.largest(), options.tolerance) {}

  SizedFit run() {
    // The number of trials is unknown: each gets half of the remaining progress.
    for (double begin = 0; const auto point = search_.next();) {
      const double end = options_.tolerance > 0 ? (begin + 1) / 2 : 1;
      const Progress::Span trial(progress_, begin, end);
      try_point(*point);
      begin = end;
    }
    if (held_ != search_.best()) best_.body = fit(search_.best());  // its errors came from the checkpoint
    best_.order = search_.measured_curve(kCurvePoints);
    best_.trials = search_.trials();
    if (!search_.met()) best_.shortfall = search_.shortfall();
    return std::move(best_);
  }

 private:
  void try_point(size_t point) {
    std::optional<ModelBody> body;
    std::optional<BtfErrors> errors = kept_errors(options_.checkpoint, point);
    if (!errors) {
      body = fit(point);
      progress_.stage("measuring the error", kTrialFit, 1);
      errors = errors_of_(*body, progress_);
      keep_errors(options_.checkpoint, point, *errors);
    }
    search_.add(point, errors->relative_l2);
    if (search_.best() != point) return;
    best_.errors = *errors;
    if (!body) return;
    best_.body = std::move(*body);
    held_ = point;
  }

  ModelBody fit(size_t point) {
    const auto start = std::chrono::steady_clock::now();
    const Progress::Span fitting(progress_, 0, kTrialFit);
    ModelBody body = fitter_.fit(point);
    best_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return body;
  }

  BtfFitter& fitter_;
  const ErrorsOf& errors_of_;
  const SizedFitOptions& options_;
  Progress& progress_;
  SizeSearch search_;
  SizedFit best_;
  std::optional<size_t> held_;  // the point whose model best_ holds
};

}  // namespace

SizedFit fit_at_size(BtfFitter& fitter, const ErrorsOf& errors_of, const SizedFitOptions& options, Progress& progress) {
  return Trials(fitter, errors_of, options, progress).run();
}

}  // namespace velour
