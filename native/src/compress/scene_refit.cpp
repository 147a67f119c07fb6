#include "compress/scene_refit.h"

#include <tbb/task_arena.h>

#include <cmath>

#include "compress/make_fitter.h"
#include "compress/scene_btf.h"
#include "compress/seen_pictures.h"
#include "compress/side_views.h"
#include "job/error.h"
#include "job/threads.h"

namespace velour {
namespace {

constexpr uint64_t kFirst = 8, kMost = 64;  // parts of the full model's bytes
constexpr double kSetup = 0.3;              // of a trial's progress

CompressMethod method_of(const ModelBody& full) {
  const auto* factored = std::get_if<FactoredBtf>(&full);
  if (!factored) return CompressMethod::srbf;
  return factored->by_view() ? CompressMethod::svd_view : CompressMethod::svd;
}

uint64_t bytes_of(const ModelBody& body) {
  return std::visit([](const auto& b) { return b.parameter_bytes(); }, body);
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

  /// Better than `levels`, or nothing.
  std::optional<SceneRefit> best(const ModelBody& levels) {
    if (pictures_.empty()) return std::nullopt;
    const double full_error = error(full_), most = kMoreError * full_error;
    if (!std::isfinite(full_error)) return std::nullopt;  // the BTF has entries that are not
    std::optional<SceneRefit> found = refit(kFirst, full_error);
    if (found && found->error <= most) {
      for (uint64_t divisor = 2 * kFirst; divisor <= kMost; divisor *= 2) {
        auto smaller = refit(divisor, full_error);
        if (!smaller || !(smaller->error <= most)) break;
        found = std::move(smaller);
      }
      return found;
    }
    auto larger = refit(kFirst / 2, full_error);
    if (larger && larger->error <= most) return larger;
    return found && found->error < error(levels) ? std::move(found) : std::nullopt;
  }

 private:
  double error(const ModelBody& body) {
    return arena_.execute([&] { return pictures_.error(body, progress_); });
  }

  std::optional<SceneRefit> refit(uint64_t divisor, double full_error) {
    auto body = fitted(divisor);
    if (!body) return std::nullopt;
    const double own_error = error(*body);
    return SceneRefit{*std::move(body), own_error, full_error};
  }

  /// Nothing where so few bytes hold no model.
  std::optional<ModelBody> fitted(uint64_t divisor) {
    options_.bytes = bytes_of(full_) / divisor;
    const double begin = done_;
    done_ = (1 + begin) / 2;  // nobody knows how many trials there will be
    const Progress::Span trial(progress_, begin, done_);
    try {
      FitCheckpoint none;
      const auto fitter = [&] {
        const Progress::Span setup(progress_, 0, kSetup);
        return make_fitter(seen_, options_, none, progress_);
      }();
      const Progress::Span fit(progress_, kSetup, 1);
      return fitter->fit(fitter->largest());
    } catch (const Error& refused) {
      if (refused.status() == Status::invalid_argument) return std::nullopt;
      throw;
    }
  }

  const BtfMeasurement& seen_;
  const ModelBody& full_;
  CompressOptions options_;
  Progress& progress_;
  double done_ = 0;  // of the progress
  tbb::task_arena arena_;
  const SeenPictures pictures_;
};

}  // namespace

std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress) {
  if (std::holds_alternative<TensorBtf>(full) || sides_of(measurement.layout()).size() != 1) return std::nullopt;
  const auto halvings = static_cast<uint32_t>(levels_of(full) - levels_of(levels));
  const auto seen =
      scene_btf(measurement, halvings, views_around(measurement.layout(), view_range(options.for_scene->domain)));
  return Refit(*seen, full, options, progress).best(levels);
}

}  // namespace velour
