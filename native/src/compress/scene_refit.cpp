#include "compress/scene_refit.h"

#include "compress/make_fitter.h"
#include "compress/scene_btf.h"
#include "compress/seen_pictures.h"
#include "compress/side_views.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr uint64_t kFirst = 8, kMost = 64;  // parts of the full model's bytes

uint64_t bytes_of(const ModelBody& body) {
  return std::visit([](const auto& b) { return b.parameter_bytes(); }, body);
}

Companding companding_of(const ModelBody& body) {
  if (const auto* factored = std::get_if<FactoredBtf>(&body)) return factored->companding;
  return std::get<SrbfBtf>(body).companding;
}

size_t levels_in(const ModelBody& body) {
  if (const auto* factored = std::get_if<FactoredBtf>(&body)) return factored->levels.size();
  return std::get<SrbfBtf>(body).sides.at(0).levels.size();
}

class Refit {
 public:
  Refit(const BtfMeasurement& seen, const ModelBody& full, const CompressOptions& options, Progress& progress)
      : seen_(seen),
        full_(full),
        options_(options),
        progress_(progress),
        pictures_(seen, *options.for_scene, progress) {
    options_.companding = companding_of(full);
    options_.method = std::holds_alternative<FactoredBtf>(full) ? CompressMethod::svd : CompressMethod::srbf;
    options_.tolerance = 0;
  }

  /// Better than `levels`, or nothing.
  std::optional<SceneRefit> best(const ModelBody& levels) {
    if (pictures_.empty()) return std::nullopt;
    const double full_error = pictures_.error(full_, progress_), most = kMoreError * full_error;
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
    return found && found->error < pictures_.error(levels, progress_) ? std::move(found) : std::nullopt;
  }

 private:
  std::optional<SceneRefit> refit(uint64_t divisor, double full_error) {
    auto body = fitted(divisor);
    if (!body) return std::nullopt;
    const double error = pictures_.error(*body, progress_);
    return SceneRefit{*std::move(body), error, full_error};
  }

  /// Nothing where so few bytes hold no model.
  std::optional<ModelBody> fitted(uint64_t divisor) {
    options_.bytes = bytes_of(full_) / divisor;
    try {
      FitCheckpoint none;
      const auto fitter = make_fitter(seen_, options_, none, progress_);
      return fitter->fit(fitter->largest());
    } catch (const Error& error) {
      if (error.status() == Status::invalid_argument) return std::nullopt;
      throw;
    }
  }

  const BtfMeasurement& seen_;
  const ModelBody& full_;
  CompressOptions options_;
  Progress& progress_;
  const SeenPictures pictures_;
};

}  // namespace

std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress) {
  if (sides_of(measurement.layout()).size() != 1) return std::nullopt;
  const auto halvings = static_cast<uint32_t>(levels_in(full) - levels_in(levels));
  const auto seen =
      scene_btf(measurement, halvings, views_around(measurement.layout(), view_range(options.for_scene->domain)));
  return Refit(*seen, full, options, progress).best(levels);
}

}  // namespace velour
