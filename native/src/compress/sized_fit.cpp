#include "compress/sized_fit.h"

#include <chrono>

#include "compress/size_search.h"

namespace velour {
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
