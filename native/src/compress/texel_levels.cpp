#include "compress/texel_levels.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "btf/bilinear_texels.h"
#include "compress/texel_solver.h"

namespace velour {
namespace {

constexpr int kSteps = 20, kCoarseSteps = 12;  // of the finest level, of coarser ones
constexpr double kReading = 0.1;               // of the progress

/// Coefficients of a finer level, interpolated.
RowMatrix refined(const RowMatrix& coarse, uint32_t width, uint32_t height, const Relief& fine) {
  RowMatrix out(Eigen::Index{fine.width()} * fine.height(), coarse.cols());
  for (uint32_t y = 0; y < fine.height(); ++y) {
    for (uint32_t x = 0; x < fine.width(); ++x) {
      const Vec2 place((static_cast<float>(x) + 0.5f) / static_cast<float>(fine.width()),
                       (static_cast<float>(y) + 0.5f) / static_cast<float>(fine.height()));
      const BilinearTexels texels = bilinear_texels(place, width, height);
      auto row = out.row(Eigen::Index{y} * fine.width() + x);
      row.setZero();
      for (size_t i = 0; i < 4; ++i) row += texels.weight[i] * coarse.row(texels.index[i]);
    }
  }
  return out;
}

template <class Values>
std::vector<HalfBits> halves_of(const Values& values, size_t count) {
  std::vector<HalfBits> halves(count);
  floats_to_halves({values.data(), count}, halves);
  return halves;
}

size_t coefficients_of(const SharedLobes& lobes) {
  return lobes.lobe[0].size() + lobes.lobe[1].size() + lobes.lobe[2].size();
}

/// Coefficients of each level, the finest first; those of the coarser ones may have been kept.
using LevelValues = std::vector<std::optional<RowMatrix>>;

LevelValues kept_levels(const TexelLevelsInput& input, const FitCheckpoint& checkpoint, const std::string& stage) {
  LevelValues values(input.relief.size());
  for (size_t l = values.size(); l-- > 0;) {
    values[l] =
        checkpoint.matrix(stage + std::to_string(l), Eigen::Index{input.relief[l].width()} * input.relief[l].height(),
                          static_cast<Eigen::Index>(coefficients_of(input.lobes)));
    if (!values[l]) break;  // finer ones were solved from it
  }
  return values;
}

using Solvers = std::vector<std::unique_ptr<TexelSolver>>;

/// Of the finest `levels`.
Solvers read_data(CompandedViews& views, const TexelLevelsInput& input, size_t levels, Progress& progress) {
  Solvers solver;
  if (levels == 0) return solver;
  for (size_t l = 0; l < levels; ++l) {
    solver.push_back(std::make_unique<TexelSolver>(input.side, input.lobes, input.relief[l], input.threads, progress));
  }
  std::vector<LevelImages> images;
  const size_t count = input.side.view.size();
  for (size_t v = 0; v < count; ++v) {
    progress.check();
    read_side_view(views, input.grid, input.side, v, levels, images);
    for (size_t l = 0; l < levels; ++l) solver[l]->add_view(v, images[l]);
    progress.update(kReading * static_cast<double>(v + 1) / static_cast<double>(count));
  }
  return solver;
}

RowMatrix solved(TexelSolver& solver, const RowMatrix& start, size_t level, Progress& progress) {
  const int steps = level == 0 ? kSteps : kCoarseSteps;
  // A level costs four times the one before: the finest takes three quarters of the time.
  const double from = kReading + (1 - kReading) * std::pow(0.25, static_cast<double>(level + 1));
  const double to = kReading + (1 - kReading) * std::pow(0.25, static_cast<double>(level));
  const auto after_step = [&](int step) { progress.update(from + (to - from) * (step + 1) / steps); };
  RowMatrix value = solver.solve(start, steps, after_step);
  progress.update(to);  // it may have settled early
  return value;
}

SrbfLevel stored(const Relief& relief, const RowMatrix& value) {
  return {relief.width(), relief.height(), halves_of(relief.heights(), size_t{relief.width()} * relief.height()),
          halves_of(value, static_cast<size_t>(value.size()))};
}

}  // namespace

std::vector<SrbfLevel> solve_levels(CompandedViews& views, const TexelLevelsInput& input, FitCheckpoint& checkpoint,
                                    const std::string& stage, Progress& progress) {
  LevelValues value = kept_levels(input, checkpoint, stage);
  const auto missing = static_cast<size_t>(std::count(value.begin(), value.end(), std::nullopt));
  Solvers solver = read_data(views, input, missing, progress);
  std::vector<SrbfLevel> levels(value.size());
  RowMatrix start = RowMatrix::Zero(1, static_cast<Eigen::Index>(coefficients_of(input.lobes)));
  for (size_t l = levels.size(); l-- > 0;) {
    const Relief& relief = input.relief[l];
    if (!value[l]) {
      value[l] = solved(*solver[l], start, l, progress);
      solver[l].reset();
      checkpoint.keep(stage + std::to_string(l), *value[l]);
      checkpoint.write();
    }
    levels[l] = stored(relief, *value[l]);
    if (l > 0) start = refined(*value[l], relief.width(), relief.height(), input.relief[l - 1]);
    value[l].reset();
  }
  return levels;
}

}  // namespace velour
