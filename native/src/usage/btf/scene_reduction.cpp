#include "usage/btf/scene_reduction.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "btf/fit/btf_compare.h"
#include "btf/fit/btf_fit.h"
#include "image/picture.h"
#include "math/sphere/frame.h"
#include "usage/btf/scene_btf.h"

namespace velour {

namespace {

/// Number of times `grid` must be halved to have `width` texels.
uint32_t halvings_to(TexelGrid grid, const TexelGrid& target) {
  uint32_t halvings = 0;
  for (; grid.width > target.width || grid.height > target.height; ++halvings) {
    grid.width = half_of(grid.width);
    grid.height = half_of(grid.height);
  }
  return halvings;
}

/// The squared relative error, from the product of the errors a - b of two independent halves.
double relmse(const std::array<std::vector<float>, 2>& a, const std::array<const std::vector<float>*, 2>& b) {
  const size_t count = a[0].size();
  double error = 0;
  for (size_t c = 0; c < 3; ++c) {
    double mean = 0;
    for (size_t i = c; i < count; i += 3) mean += 0.5 * (static_cast<double>((*b[0])[i]) + (*b[1])[i]);
    mean *= 3 / static_cast<double>(count);
    for (size_t i = c; i < count; i += 3) {
      const double first = static_cast<double>(a[0][i]) - (*b[0])[i],
                   second = static_cast<double>(a[1][i]) - (*b[1])[i];
      const double y = 0.5 * (static_cast<double>((*b[0])[i]) + (*b[1])[i]);
      if (y != 0 || mean != 0) error += first * second / (y * y + relmse_floor(mean));
    }
  }
  return error / static_cast<double>(count);
}

}  // namespace

SeenPictures::SeenPictures(const BtfMeasurement& truth, const SceneObservation& observation, const Progress& progress)
    : truth_(truth), between_(truth.layout()) {
  const bool two_sided = has_lower_side(truth.layout());
  for (const ObservedHit& hit : observation.hits) {
    if (pictures_.size() == kPictures) return;
    const bool mirrored = hit.back && two_sided;
    Picture picture{mirrored ? velour::mirrored(hit.wv) : hit.wv,
                    {half_of_hit(hit, false, observation, mirrored), half_of_hit(hit, true, observation, mirrored)}};
    if (!between_.view(picture.wv) || picture.half[0].light.empty() || picture.half[1].light.empty()) continue;
    for (Half& half : picture.half) half.radiance = true_radiance(picture.wv, half, progress);
    pictures_.push_back(std::move(picture));
  }
}

SeenPictures::Half SeenPictures::half_of_hit(const ObservedHit& hit, bool second, const SceneObservation& observation,
                                             bool mirrored) const {
  Half half;
  for (uint32_t i = second ? hit.middle : hit.first; i < (second ? hit.last : hit.middle); ++i) {
    const Vec3 wl = mirrored ? velour::mirrored(observation.wl[i]) : observation.wl[i];
    const float amount = luminance(observation.light[i]);
    if (amount > 0 && between_.light(wl)) half.light.push_back({wl, amount});
  }
  return half;
}

std::vector<float> SeenPictures::true_radiance(const Vec3& wv, const Half& half, const Progress& progress) const {
  std::map<uint64_t, float> pairs;  // weight of each pair
  const auto views = between_.view(wv);
  for (const Light& light : half.light) {
    const auto lights = between_.light(light.wl);
    for (size_t v = 0; v < 3; ++v) {
      for (size_t l = 0; l < 3; ++l) {
        const float weight = light.amount * views->weight[v] * lights->weight[l];
        if (weight > 0) pairs[truth_.layout().first(views->index[v]) + lights->index[l]] += weight;
      }
    }
  }
  std::vector<HalfBits> halves(truth_.grid().texels() * 3);
  std::vector<float> rgb(halves.size()), sum(halves.size(), 0.0f);
  for (const auto& [pair, weight] : pairs) {
    progress.check();
    truth_.read_pairs(pair, 1, halves);
    halves_to_floats(halves, rgb);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += weight * rgb[i];
  }
  return halved_image(std::move(sum), truth_.grid(), 3, 1);
}

std::vector<float> SeenPictures::picture_of(const BtfImages& images, const TexelGrid& grid, const Vec3& wv,
                                            const Half& half, const Progress& progress) const {
  std::vector<float> rgb, sum(grid.texels() * 3, 0.0f);
  for (const Light& light : half.light) {
    progress.check();
    images({light.wl, wv}, rgb);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += light.amount * rgb[i];
  }
  return halved_image(std::move(sum), grid, 3, halvings_to(grid, truth_.grid()) + 1);
}

double SeenPictures::error(const ModelBody& body, const Progress& progress) const {
  const BtfImages images = images_of(body);
  const TexelGrid grid = with_btf(body, [](const auto& btf) { return btf.grid; });
  std::vector<double> errors(pictures_.size());
  tbb::parallel_for(size_t{0}, pictures_.size(), [&](size_t p) {
    const Picture& picture = pictures_[p];
    const auto& [one, other] = picture.half;
    errors[p] = relmse(
        {picture_of(images, grid, picture.wv, one, progress), picture_of(images, grid, picture.wv, other, progress)},
        {&one.radiance, &other.radiance});
  });
  return std::max(0.0, std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size()));
}

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

namespace {

constexpr double kFullFit = 0.7;  // fraction of the progress, if the full model is fitted first

const SceneObservation& checked(const CompressOptions& options) {
  if (options.for_scene->hits.empty()) {
    throw Error(Status::invalid_argument,
                "The scene does not show the material: no camera ray hits it. Check camera, visibility and frames, or "
                "compress without a scene.");
  }
  if (options.for_scene->domain.surface.weight() > 0) return *options.for_scene;
  throw Error(Status::invalid_argument,
              "The scene usage does not contain the resolution at which the surface is shown, because it was observed "
              "with a material that does not vary over the surface. Observe the scene again with the BTF or its model "
              "as the material.");
}

Model checked_full_model(const BtfMeasurement& measurement, const Model& model) {
  const auto refuse = [](const std::string& what) {
    throw Error(Status::invalid_argument,
                "The full model for a scene model must be a model of the same BTF that is not reduced to a scene; this "
                "one is " +
                    what + ".");
  };
  if (!is_btf(model)) refuse("a BRDF model");
  if (is_reduced(model)) refuse("itself a scene model");
  if (model.source.sha256 != measurement.provenance().sha256) {
    refuse("a model of '" + model.source.name + "', whose content differs from that of '" +
           measurement.provenance().name + "'");
  }
  return model;
}

Model full_model(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
  if (options.full_model) return checked_full_model(measurement, *options.full_model);
  const Progress::Span fitting(progress, 0, kFullFit);
  return compress_btf(measurement, options, progress);
}

/// Uses a refit if it is no larger than the model without its `count` finest levels, otherwise that model.
void reduce(const BtfMeasurement& measurement, size_t count, const CompressOptions& options, Model& model,
            SceneRecord& record, Progress& progress) {
  if (count == 0) return;
  if (std::holds_alternative<TensorBtf>(model.body)) {
    model.btf->warnings.push_back(warning<WarningCode::only_finest_levels_left_out>());
  }
  ModelBody levels = without_finest(model.body, count);
  auto refit = refit_for_scene(measurement, model.body, levels, options, progress);
  if (!refit || parameter_bytes(refit->body) > parameter_bytes(levels)) {
    model.body = std::move(levels);
    return;
  }
  record.picture_error = refit->error;
  record.full_picture_error = refit->full_error;
  record.seen_views_alone = true;
  if (!has_lower_side(measurement.layout())) {  // it shows its front from behind
    record.domain.surface.views = from_both_sides(record.domain.directions());
  }
  model.body = std::move(refit->body);
}

}  // namespace

Model compress_for_scene(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress) {
  const SceneObservation& observation = checked(options);
  Model model = full_model(measurement, options, progress);
  model.btf.value().verdict = std::nullopt;  // on the full model
  const Progress::Span reducing(progress, options.full_model ? 0 : kFullFit, 1.0);
  progress.stage("reducing to the scene", 0, 1);
  SceneRecord record;
  record.domain = observation.domain;
  record.full_parameter_bytes = parameter_bytes(model.body);
  record.full_texels = {grid_of(model)->width, grid_of(model)->height};
  const size_t count = unresolved_levels(model.body, observation.domain.surface);
  reduce(measurement, count, options, model, record, progress);
  if (count == 0) model.btf->warnings.push_back(warning<WarningCode::scene_shows_finest_texels>());
  model.scene = std::move(record);
  progress.update(1.0);
  return model;
}

namespace {

/// Between `size`, which is too small, and its double: the first good one of four steps per octave.
size_t least_between(size_t size, size_t end, const std::function<bool(size_t)>& good) {
  std::array<size_t, 4> sizes{};
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double part = std::exp2(static_cast<double>(i + 1) / static_cast<double>(sizes.size()));
    sizes[i] = static_cast<size_t>(static_cast<double>(size + 1) * part + 0.5) - 1;
  }
  const auto distinct = std::unique(sizes.begin(), sizes.end());
  return *std::partition_point(sizes.begin(), distinct - 1, [&](size_t s) { return s < end && !good(s); });
}

}  // namespace

size_t least_size(size_t end, const std::function<bool(size_t)>& good) {
  if (end == 0 || good(0)) return 0;
  size_t bad = 0;
  for (size_t size = 1; size < end && !good(size); size = 2 * size + 1) bad = size;
  return std::min(end, least_between(bad, end, good));
}

}  // namespace velour
