#include "compress/tensor_levels.h"

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "compress/brightening.h"
#include "compress/relief_pyramid.h"
#include "compress/tensor_rounding.h"

namespace velour {
namespace {

constexpr double kReading = 0.4;  // of the progress

using Levels = std::vector<std::optional<TensorTexelValues>>;

/// Members and values, as one matrix: [texel][members, values].
std::optional<TensorTexelValues> kept_level(const FitCheckpoint& checkpoint, const std::string& stage,
                                            const Relief& relief, const TensorSide& side) {
  const Index members = side.members, values = members * side.rank.texel;
  const auto kept = checkpoint.matrix(stage, Index{relief.width()} * relief.height(), members + values);
  if (!kept) return std::nullopt;
  TensorTexelValues level{{}, kept->rightCols(values)};
  for (Index t = 0; t < kept->rows(); ++t) {
    for (Index k = 0; k < members; ++k) {
      const float member = (*kept)(t, k);
      if (!(member >= 0 && member < static_cast<float>(side.clusters.size()) && member == std::floor(member))) {
        return std::nullopt;
      }
      level.member.push_back(static_cast<uint32_t>(member));
    }
  }
  return level;
}

void keep_level(const TensorTexelValues& level, const std::string& stage, FitCheckpoint& checkpoint) {
  const Index rows = level.value.rows(), members = static_cast<Index>(level.member.size()) / rows;
  RowMatrix kept(rows, members + level.value.cols());
  for (Index t = 0; t < rows; ++t) {
    for (Index k = 0; k < members; ++k)
      kept(t, k) = static_cast<float>(level.member[static_cast<size_t>(t * members + k)]);
  }
  kept.rightCols(level.value.cols()) = level.value;
  checkpoint.keep(stage, kept);
  checkpoint.write();
}

using Solvers = std::vector<std::unique_ptr<TensorTexels>>;

/// Of the levels that were not kept, all images.
Solvers read_images(CompandedViews& views, const TensorSource& source, const TensorFunctions& functions,
                    const Levels& kept, Progress& progress) {
  Solvers solver(kept.size());
  size_t most = 0;
  for (size_t l = 0; l < kept.size(); ++l) {
    if (kept[l]) continue;
    solver[l] = std::make_unique<TensorTexels>(source, l, functions, progress);
    most = l + 1;
  }
  if (most == 0) return solver;
  std::vector<LevelImages> images;
  for (size_t v = 0; v < source.side.view.size(); ++v) {
    progress.check();
    read_side_view(views, source.grid, source.side, v, most, images);
    const TensorFunctions::OfView of_view = functions.of_view(static_cast<Index>(v));
    for (size_t l = 0; l < most; ++l) {
      if (solver[l]) solver[l]->add_view(static_cast<Index>(v), images[l], of_view);
    }
    progress.update(kReading * static_cast<double>(v + 1) / static_cast<double>(source.side.view.size()));
  }
  return solver;
}

/// As bright as the images.
TensorTexelValues solved(const TensorTexels& solver, const TensorSide& side, Companding companding, size_t level,
                         Progress& progress) {
  // A level costs four times the one after it: the finest takes three quarters of the time.
  const double from = kReading + (1 - kReading) * std::pow(0.25, static_cast<double>(level + 1));
  const double to = kReading + (1 - kReading) * std::pow(0.25, static_cast<double>(level));
  TensorTexelValues values =
      solver.solve(side.members, [&](double part) { progress.update(from + (to - from) * part); });
  values.value *= brightening(companding, solver.measured(), solver.modelled(values));
  return values;
}

}  // namespace

void solve_tensor_levels(CompandedViews& views, const TensorSource& source, Companding companding,
                         FitCheckpoint& checkpoint, const std::string& stage, Progress& progress, TensorSide& side) {
  const TensorFunctions functions(side, source.threads, progress);
  Levels values(source.relief.size());
  for (size_t l = 0; l < values.size(); ++l) {
    values[l] = kept_level(checkpoint, stage + std::to_string(l), source.relief[l], side);
  }
  Solvers solver = read_images(views, source, functions, values, progress);
  std::vector<TensorTexelValues> levels(values.size());
  for (size_t l = values.size(); l-- > 0;) {
    if (!values[l]) {
      values[l] = solved(*solver[l], side, companding, l, progress);
      solver[l].reset();
      keep_level(*values[l], stage + std::to_string(l), checkpoint);
    }
    levels[l] = std::move(*values[l]);
  }
  side.levels.clear();
  for (const Relief& relief : source.relief) {
    side.levels.push_back({relief.width(), relief.height(), {}, {}, {}});
    if (!is_plane(source.relief[0])) side.levels.back().relief = stored_heights(relief);
  }
  set_rounded(functions, std::move(levels), side);
}

}  // namespace velour
