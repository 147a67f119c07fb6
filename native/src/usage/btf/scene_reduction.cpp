#include "usage/btf/scene_reduction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include "base/error.h"
#include "usage/btf/scene_btf.h"
#include "usage/btf/scene_refit.h"

namespace velour {

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
