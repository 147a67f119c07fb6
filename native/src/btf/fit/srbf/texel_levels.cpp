#include "btf/fit/srbf/texel_levels.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "btf/fit/byte_rounding.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/srbf/texel_solver.h"
#include "image/bilinear_texels.h"

namespace velour {
namespace {

constexpr int kFinestSteps = 20, kCoarseSteps = 12;  // on the finest level, on coarser ones
constexpr double kTexelReading = 0.1;                // fraction of the progress

/// Interpolates coefficients to a finer level.
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

size_t coefficients_of(const SharedLobes& lobes) {
  return lobes.lobe[0].size() + lobes.lobe[1].size() + lobes.lobe[2].size();
}

/// Solved coefficients of a level, and the factor that makes them as bright as the data.
struct Solution {
  RowMatrix value;
  double brightening = 1;
};

/// Per level, finest first; coarser ones may have been restored.
using Solutions = std::vector<std::optional<Solution>>;

constexpr char kBrightening[] = ".brightening";

std::optional<Solution> kept_level(const TexelLevelsInput& input, const FitCheckpoint& checkpoint,
                                   const std::string& stage, const Relief& relief) {
  auto value = checkpoint.matrix(stage, Eigen::Index{relief.width()} * relief.height(),
                                 static_cast<Eigen::Index>(coefficients_of(input.lobes)));
  const auto factor = checkpoint.numbers(stage + kBrightening, 1);
  if (!value || !factor || factor->size() != 1) return std::nullopt;
  return Solution{std::move(*value), (*factor)[0]};
}

Solutions kept_levels(const TexelLevelsInput& input, const FitCheckpoint& checkpoint, const std::string& stage) {
  Solutions levels(input.relief.size());
  for (size_t l = levels.size(); l-- > 0;) {
    levels[l] = kept_level(input, checkpoint, stage + std::to_string(l), input.relief[l]);
    if (!levels[l]) break;  // finer levels start from it
  }
  return levels;
}

void keep_level(const Solution& level, const std::string& stage, FitCheckpoint& checkpoint) {
  checkpoint.keep(stage, level.value);
  checkpoint.keep_numbers(stage + kBrightening, {&level.brightening, 1});
  checkpoint.write();
}

using Solvers = std::vector<std::unique_ptr<TexelSolver>>;

/// Reads the data of the finest `levels` levels.
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
    progress.update(kTexelReading * static_cast<double>(v + 1) / static_cast<double>(count));
  }
  return solver;
}

Solution solved(const TexelLevelsInput& input, TexelSolver& solver, const RowMatrix& start, size_t level,
                Progress& progress) {
  const int steps = level == 0 ? kFinestSteps : kCoarseSteps;
  // A level costs four times the next coarser one: the finest takes three quarters of the time.
  const double from = kTexelReading + (1 - kTexelReading) * std::pow(0.25, static_cast<double>(level + 1));
  const double to = kTexelReading + (1 - kTexelReading) * std::pow(0.25, static_cast<double>(level));
  const auto after_step = [&](int step) { progress.update(from + (to - from) * (step + 1) / steps); };
  RowMatrix value = solver.solve(start, steps, after_step);
  progress.update(to);  // it may have converged early
  const float factor = brightening(input.companding, solver.measured(), solver.modelled(value));
  return {std::move(value), static_cast<double>(factor)};
}

/// Coefficients of all texels, as bright as the data.
std::vector<float> bright_values(const Solution& level) {
  const RowMatrix bright = level.value * static_cast<float>(level.brightening);
  return {bright.data(), bright.data() + bright.size()};
}

}  // namespace

void solve_levels(CompandedViews& views, const TexelLevelsInput& input, FitCheckpoint& checkpoint,
                  const std::string& stage, Progress& progress, SrbfSide& side) {
  Solutions solution = kept_levels(input, checkpoint, stage);
  const auto missing =
      static_cast<size_t>(std::count_if(solution.begin(), solution.end(), [](const auto& s) { return !s; }));
  Solvers solver = read_data(views, input, missing, progress);
  side.levels.resize(solution.size());
  std::vector<std::vector<float>> values(solution.size());
  RowMatrix start = RowMatrix::Zero(1, static_cast<Eigen::Index>(coefficients_of(input.lobes)));
  for (size_t l = values.size(); l-- > 0;) {
    const Relief& relief = input.relief[l];
    if (!solution[l]) {
      solution[l] = solved(input, *solver[l], start, l, progress);
      solver[l].reset();
      keep_level(*solution[l], stage + std::to_string(l), checkpoint);
    }
    side.levels[l] = {relief.width(), relief.height(), stored_heights(relief), {}};
    values[l] = bright_values(*solution[l]);
    if (l > 0) start = refined(solution[l]->value, relief.width(), relief.height(), input.relief[l - 1]);
    solution[l].reset();
  }
  // Products on the finest level, whether its solver was needed or not.
  const TexelSolver finest(input.side, input.lobes, input.relief[0], input.threads, progress);
  set_rounded(finest.products(), std::move(values), side);
}

}  // namespace velour
