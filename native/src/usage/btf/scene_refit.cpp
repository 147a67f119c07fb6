#include "usage/btf/scene_refit.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "btf/fit/btf_fit.h"
#include "usage/btf/scene_btf.h"
#include "usage/btf/scene_reduction.h"
#include "usage/btf/seen_pictures.h"

namespace velour {
namespace {

constexpr uint64_t kMaxReduction = 64;  // smallest model tried: the full model's bytes over this
constexpr double kRefitSetup = 0.3;     // fraction of the progress
constexpr size_t kJudgedSize = 15;      // size at which the relief and the plane are compared
constexpr int kMaxRefitTrials = 9;      // trials of least_size: doublings from the smallest model on, and two more

CompressMethod method_of(const ModelBody& full) {
  const auto* factored = std::get_if<FactoredBtf>(&full);
  if (!factored) return CompressMethod::srbf;
  return factored->by_view() ? CompressMethod::svd_view : CompressMethod::svd;
}

size_t levels_in(const FactoredBtf& btf) { return btf.levels.size(); }
template <typename Btf>
size_t levels_in(const Btf& btf) {
  return btf.sides.at(0).levels.size();
}
size_t levels_of(const ModelBody& body) {
  return with_btf(body, [](const auto& btf) { return levels_in(btf); });
}

class Refit {
 public:
  Refit(const BtfMeasurement& seen, const ModelBody& full, const CompressOptions& options, Progress& progress)
      : seen_(seen),
        full_(full),
        options_(options),
        progress_(progress),
        arena_(arena_concurrency(options.threads)),
        pictures_(seen, *options.for_scene, progress) {
    options_.companding = with_btf(full, [](const auto& btf) { return btf.companding; });
    options_.tolerance = 0;
    options_.method = method_of(full);
  }

  /// A refit that is better than `levels`, if there is one.
  std::optional<SceneRefit> best(const ModelBody& levels) {
    if (pictures_.empty()) return std::nullopt;
    full_error_ = error(full_);
    if (!std::isfinite(full_error_)) return std::nullopt;  // the BTF has entries that are not finite
    auto fitter = fitter_within(parameter_bytes(levels));
    if (!fitter) return std::nullopt;
    if (options_.method == CompressMethod::srbf && seen_.has_structure()) fitter = better_of(std::move(fitter));
    least_size(fitter->largest() + 1, [&](size_t size) { return is_good(*fitter, size); });
    if (good_) return std::move(good_);
    return last_ && last_->error < error(levels) ? std::move(last_) : std::nullopt;
  }

 private:
  double error(const ModelBody& body) {
    return arena_.execute([&] { return pictures_.error(body, progress_); });
  }

  /// Chooses between the relief and the plane by a fit of a fixed size, whatever size is requested. The relief's
  /// heights are as coarse as the texels, and for views that lie close together some tiles look better as a plane.
  std::unique_ptr<BtfFitter> better_of(std::unique_ptr<BtfFitter> over_relief) {
    const double begin = done_;
    done_ = kRefitSetup;
    const Progress::Span setups(progress_, begin, done_);
    const size_t size = std::min(kJudgedSize, over_relief->largest());
    const double with_relief = error(over_relief->fit(size));
    options_.relief = false;
    auto on_plane = fitter_within(options_.bytes);
    if (on_plane && error(on_plane->fit(size)) < with_relief) return on_plane;
    options_.relief = true;
    return over_relief;
  }

  /// Null if so few bytes do not hold a model.
  std::unique_ptr<BtfFitter> fitter_within(uint64_t bytes) {
    options_.bytes = bytes;
    const Progress::Span setup(progress_, 0, kRefitSetup / 3);
    try {
      return make_fitter(seen_, options_, none_, progress_);
    } catch (const Error& refused) {
      if (refused.status() == Status::invalid_argument) return nullptr;
      throw;
    }
  }

  /// Fits this size unless it is below the smallest one tried. Keeps the smallest good fit, otherwise the largest.
  bool is_good(BtfFitter& fitter, size_t size) {
    if (fitter.curve().points[size].parameter_bytes < parameter_bytes(full_) / kMaxReduction) return false;
    const double begin = done_;
    done_ = std::min(1.0, begin + (1 - kRefitSetup) / kMaxRefitTrials);
    const Progress::Span trial(progress_, begin, done_);
    SceneRefit refit{fitter.fit(size), 0, full_error_};
    refit.error = error(refit.body);
    const bool good = refit.error <= kMoreError * full_error_;
    (good ? good_ : last_) = std::move(refit);
    return good;
  }

  const BtfMeasurement& seen_;
  const ModelBody& full_;
  CompressOptions options_;
  Progress& progress_;
  FitCheckpoint none_;
  double done_ = kRefitSetup / 3;  // fraction of the progress
  double full_error_ = 0;
  std::optional<SceneRefit> good_, last_;
  tbb::task_arena arena_;
  const SeenPictures pictures_;
};

}  // namespace

std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress) {
  if (std::holds_alternative<TensorBtf>(full)) return std::nullopt;
  const auto halvings = static_cast<uint32_t>(levels_of(full) - levels_of(levels));
  SeenPairs pairs = pairs_around(measurement.layout(), options.for_scene->domain.directions());
  if (pairs.views.empty() || pairs.lights.empty()) return std::nullopt;
  const auto seen = scene_btf(measurement, halvings, std::move(pairs));
  return Refit(*seen, full, options, progress).best(levels);
}

}  // namespace velour
