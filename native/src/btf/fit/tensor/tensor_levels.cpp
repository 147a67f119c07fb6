#include "btf/fit/tensor/tensor_texels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include "base/parallel.h"
#include "btf/fit/byte_rounding.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/tensor/function_refit.h"
#include "btf/fit/tensor/tensor_checkpoint.h"

namespace velour {

namespace {

constexpr double kTensorReading = 0.4, kMoments = 0.7;  // fractions of a stage's progress
constexpr double kFirst = 0.35, kRefitted = 0.5, kSecond = 0.85;
constexpr int kRounds = 2;

/// The values that the bytes of a level represent.
TensorTexelValues stored_values(const TensorSide& side, const TensorLevel& level) {
  const size_t rank = side.rank.texel;
  TensorTexelValues values{
      {level.member.begin(), level.member.end()},
      RowMatrix(static_cast<Index>(level.member.size() / side.members), static_cast<Index>(side.members * rank))};
  for (size_t i = 0; i < level.value.size(); ++i) {
    values.value.data()[i] = side.clusters[level.member[i / rank]].scale[i % rank].value(level.value[i]);
  }
  return values;
}

/// Fits the levels of a side.
class LevelFit {
 public:
  LevelFit(CompandedViews& views, const TensorSource& source, Companding companding, FitCheckpoint& checkpoint,
           Progress& progress, TensorSide& side)
      : views_(views),
        source_(source),
        companding_(companding),
        checkpoint_(checkpoint),
        progress_(progress),
        side_(side),
        bright_(source.relief.size(), 1.0f) {
    for (size_t l = 0; l < source.relief.size(); ++l) {
      seen_.emplace_back(source, l, progress);
      shown_.emplace_back(source, l, progress);
    }
  }

  /// Solves for the texels of every level with the current clusters; checkpoints under `stage`.
  void solve(const TensorFunctions& functions, const std::string& stage);
  /// Scales the levels to the brightness of their images.
  void brighten(const TensorFunctions& functions);
  void round(const TensorFunctions& functions);
  /// Refits the clusters to the current texels.
  void refit();
  /// Scales the cores so that the stored finest level is as bright as its images.
  void mend_brightness();

 private:
  using Solvers = std::vector<std::unique_ptr<TensorTexels>>;
  Solvers read_images(const TensorFunctions& functions, const std::vector<bool>& kept);
  TensorTexelValues solved(const TensorTexels& solver, size_t level);
  std::vector<ViewMoments> moments();

  CompandedViews& views_;
  const TensorSource& source_;
  Companding companding_;
  FitCheckpoint& checkpoint_;
  Progress& progress_;
  TensorSide& side_;
  std::vector<SeenTexels> seen_;
  std::vector<ShownViews> shown_;
  std::vector<TensorTexelValues> values_;
  std::vector<double> measured_;  // per level
  std::vector<float> bright_;     // per level
};

void LevelFit::solve(const TensorFunctions& functions, const std::string& stage) {
  const size_t levels = seen_.size();
  values_.assign(levels, {});
  measured_.assign(levels, 0);
  std::vector<bool> kept(levels);
  for (size_t l = 0; l < levels; ++l) {
    auto level = kept_level(checkpoint_, stage + std::to_string(l), source_.relief[l], side_);
    if (!level) continue;
    kept[l] = true;
    values_[l] = std::move(level->values);
    measured_[l] = level->measured;
  }
  Solvers solver = read_images(functions, kept);
  for (size_t l = levels; l-- > 0;) {
    if (kept[l]) continue;
    measured_[l] = solver[l]->measured();
    values_[l] = solved(*solver[l], l);
    solver[l].reset();
    keep_level({values_[l], measured_[l]}, stage + std::to_string(l), checkpoint_);
  }
}

/// Reads all images of the levels that were not restored.
LevelFit::Solvers LevelFit::read_images(const TensorFunctions& functions, const std::vector<bool>& kept) {
  Solvers solver(kept.size());
  size_t most = 0;
  for (size_t l = 0; l < kept.size(); ++l) {
    if (kept[l]) continue;
    solver[l] = std::make_unique<TensorTexels>(source_, seen_[l], shown_[l], functions, progress_);
    most = l + 1;
  }
  if (most == 0) return solver;
  std::vector<FunctionsOfView> of_views;
  for (Index v = 0; v < functions.views(); ++v) of_views.push_back(functions.of_view(v));
  std::vector<LevelImages> images;
  for (size_t v = 0; v < source_.side.view.size(); ++v) {
    progress_.check();
    read_side_view(views_, source_.grid, source_.side, v, most, images);
    for (size_t l = 0; l < most; ++l) {
      if (solver[l]) solver[l]->add_view(static_cast<Index>(v), images[l], of_views);
    }
    progress_.update(kTensorReading * static_cast<double>(v + 1) / static_cast<double>(source_.side.view.size()));
  }
  return solver;
}

TensorTexelValues LevelFit::solved(const TensorTexels& solver, size_t level) {
  // A level costs four times the next coarser one: the finest takes three quarters of the time.
  const double from = kTensorReading + (1 - kTensorReading) * std::pow(0.25, static_cast<double>(level + 1));
  const double to = kTensorReading + (1 - kTensorReading) * std::pow(0.25, static_cast<double>(level));
  return solver.solve(side_.members, [&](double part) { progress_.update(from + (to - from) * part); });
}

void LevelFit::brighten(const TensorFunctions& functions) {
  for (size_t l = 0; l < values_.size(); ++l) {
    const double modelled = modelled_squares(source_, seen_[l], functions, values_[l], progress_);
    bright_[l] = brightening(companding_, measured_[l], modelled);
    values_[l].value *= bright_[l];
  }
}

void LevelFit::round(const TensorFunctions& functions) {
  set_rounded(functions, values_, source_.threads, progress_, side_);
  for (size_t l = 0; l < values_.size(); ++l) values_[l] = stored_values(side_, side_.levels[l]);
}

std::vector<ViewMoments> LevelFit::moments() {
  std::vector<ViewMoments> moments(source_.side.view.size(),
                                   ViewMoments(static_cast<Index>(side_.clusters.size()) * side_.rank.texel,
                                               static_cast<Index>(source_.side.light.size())));
  std::vector<LevelImages> images;
  for (size_t v = 0; v < source_.side.view.size(); ++v) {
    progress_.check();
    read_side_view(views_, source_.grid, source_.side, v, seen_.size(), images);
    for (size_t l = 0; l < seen_.size(); ++l) {
      add_level(seen_[l], static_cast<Index>(v), images[l], values_[l], bright_[l], source_.threads, progress_,
                moments[v]);
      add_hidden(shown_[l], static_cast<Index>(v), images[l], values_[l], bright_[l], source_.threads, progress_,
                 moments);
    }
    progress_.update(kMoments * static_cast<double>(v + 1) / static_cast<double>(source_.side.view.size()));
  }
  return moments;
}

void LevelFit::refit() {
  std::vector<DirectionCluster> clusters = direction_clusters(side_);
  refit_functions(moments(), {kRounds, source_.threads}, progress_, clusters);
  for (size_t c = 0; c < clusters.size(); ++c) store(clusters[c], side_.clusters[c]);
}

void LevelFit::mend_brightness() {
  const TensorFunctions functions(side_, source_.threads, progress_);
  const double modelled = modelled_squares(source_, seen_[0], functions, values_[0], progress_);
  const float factor = brightening(companding_, measured_[0], modelled);
  std::vector<DirectionCluster> clusters = direction_clusters(side_);
  for (size_t c = 0; c < clusters.size(); ++c) {
    clusters[c].core *= factor;
    store(clusters[c], side_.clusters[c]);
  }
}

}  // namespace

void solve_tensor_levels(CompandedViews& views, const TensorSource& source, Companding companding,
                         FitCheckpoint& checkpoint, const std::string& stage, Progress& progress, TensorSide& side) {
  side.levels.clear();
  for (const Relief& relief : source.relief) {
    side.levels.push_back({relief.width(), relief.height(), {}, {}, {}});
    if (!is_plane(source.relief[0])) side.levels.back().relief = stored_heights(relief);
  }
  LevelFit fit(views, source, companding, checkpoint, progress, side);
  if (!take_kept_clusters(checkpoint, stage + "refit.", source.side, side)) {
    progress.stage("fitting texels", 0, kFirst);
    fit.solve(TensorFunctions(side, source.threads, progress), stage + "first.");
    progress.stage("refitting functions", kFirst, kRefitted);
    fit.refit();
    checkpoint.forget(stage + "first.");
    keep_clusters(checkpoint, stage + "refit.", side);
  }
  progress.stage("fitting texels", kRefitted, kSecond);
  {
    const TensorFunctions functions(side, source.threads, progress);
    fit.solve(functions, stage);
    fit.brighten(functions);
    fit.round(functions);
  }
  progress.stage("refitting functions", kSecond, 1);
  fit.refit();
  fit.mend_brightness();
  progress.update(1);
}

namespace {

/// Calls use(cluster, rank, value) for every value.
template <class Use>
void for_values(const TensorTexelValues& level, size_t rank, const Use& use) {
  for (size_t i = 0; i < level.member.size(); ++i) {
    for (size_t r = 0; r < rank; ++r) use(level.member[i], r, level.value.data()[i * rank + r]);
  }
}

void set_scales(const std::vector<TensorTexelValues>& levels, TensorSide& side) {
  struct Range {
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
  };
  const size_t rank = side.rank.texel;
  std::vector<Range> range(side.clusters.size() * rank);
  for (const TensorTexelValues& level : levels) {
    for_values(level, rank, [&](uint32_t c, size_t r, float value) {
      Range& of = range[c * rank + r];
      of = {std::min(of.least, value), std::max(of.most, value)};
    });
  }
  for (size_t i = 0; i < range.size(); ++i) {
    const bool unused = range[i].least > range[i].most;
    side.clusters[i / rank].scale.push_back(unused ? ByteScale{}
                                                   : ByteScale{range[i].least, (range[i].most - range[i].least) / 255});
  }
}

/// Rounds a texel's coefficients one after the other.
void round_texel(const TensorSide& side, const uint32_t* member, const Eigen::MatrixXf& moves, float* value,
                 uint8_t* bytes) {
  const size_t rank = side.rank.texel, count = side.members * rank;
  for (size_t k = 0; k < count; ++k) {
    const ByteScale& scale = side.clusters[member[k / rank]].scale[k % rank];
    bytes[k] = scale.nearest(value[k]);
    const float error = value[k] - scale.value(bytes[k]);
    for (size_t j = k + 1; j < count; ++j) {
      value[j] -= error * moves(static_cast<Index>(k), static_cast<Index>(j));
    }
  }
}

}  // namespace

void set_rounded(const TensorFunctions& functions, std::vector<TensorTexelValues> levels, int threads,
                 const Progress& progress, TensorSide& side) {
  set_scales(levels, side);
  for (size_t l = 0; l < levels.size(); ++l) {
    TensorTexelValues& from = levels[l];
    TensorLevel& to = side.levels[l];
    to.member.assign(from.member.begin(), from.member.end());
    to.value.resize(static_cast<size_t>(from.value.size()));
    const MemberSets sets(from);
    parallel_pieces(sets.size(), threads, progress, [&](size_t set) {
      const Eigen::MatrixXf moves =
          rounding_moves(TensorFunctions::of_members(functions.products(), functions.rank(), sets.members(set), 0));
      for (const uint32_t t : sets.texels(set)) {
        const auto first = static_cast<size_t>(t) * static_cast<size_t>(from.value.cols());
        round_texel(side, from.member.data() + size_t{t} * side.members, moves, from.value.data() + first,
                    to.value.data() + first);
      }
    });
  }
}

}  // namespace velour
