#include "compress/srbf_fit.h"

#include <algorithm>
#include <memory>
#include <string>

#include "btf/bilinear_texels.h"
#include "compress/brightening.h"
#include "compress/relief_pyramid.h"
#include "compress/shared_lobes.h"
#include "compress/texel_solver.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr uint32_t kMostPoints = 400, kLeastPoints = 24, kPairs = 900;  // that lobes are refined by
constexpr uint64_t kTexelsOfAPoint = 4;  // few texels have little to say: their lobes take less time
constexpr int kRefinements = 100;
constexpr int kSteps = 20, kCoarseSteps = 12;  // of the texels' solve: finest level, coarser ones
constexpr uint64_t kUsualRatio = 400, kUsualLeast = 16;

/// Coefficients of a texel that fit when the sides share the bytes evenly.
size_t coefficients_within(uint64_t asked, const BtfMeasurement& measurement, size_t sides) {
  const uint64_t texels = pyramid_texels(measurement.grid());
  const uint64_t one = sides * (texels + sizeof(MultivariateLobe) + sizeof(uint16_t) + sizeof(ByteScale));
  const uint64_t relief = sides * texels * sizeof(HalfBits);
  const uint64_t bytes =
      asked > 0 ? asked : std::max(measurement.raw_bytes() / kUsualRatio, kUsualLeast * one + relief);
  if (bytes < one + relief) {
    throw Error(Status::invalid_argument, "The least model takes " + std::to_string(one + relief) + " bytes, and " +
                                              std::to_string(bytes) + " were asked for; ask for more.");
  }
  return static_cast<size_t>(std::min<uint64_t>((bytes - relief) / one, 2 * SrbfBtf::kMaxLobes));
}

uint32_t points_for(const TexelGrid& grid) {
  return static_cast<uint32_t>(std::clamp<uint64_t>(grid.texels() / kTexelsOfAPoint, kLeastPoints, kMostPoints));
}

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

std::vector<HalfBits> halves_of(const std::vector<float>& floats) {
  std::vector<HalfBits> halves(floats.size());
  floats_to_halves(floats, halves);
  return halves;
}

/// One side, from its share of the progress.
class SideFitter {
 public:
  SideFitter(const BtfMeasurement& measurement, CompandedViews& views, const SideDirections& side,
             const BtfFitOptions& options, size_t coefficients, Progress& progress)
      : grid_(measurement.grid()),
        views_(views),
        side_(side),
        options_(options),
        coefficients_(coefficients),
        progress_(progress),
        relief_(relief_pyramid(measurement, side)) {}

  /// Progress runs from `first` by `share`.
  SrbfSide fit(double first, double share) {
    const auto stage = [&](const char* name, double from, double to) {
      progress_.stage(name, first + share * from, first + share * to);
    };
    stage("points", 0, 0.05);
    const SurfacePointOptions sampling{points_for(grid_), kPairs, options_.seed};
    const auto points = surface_points(views_, grid_, side_, relief_[0], sampling, progress_);
    stage("lobes", 0.05, 0.45);
    const SharedLobeOptions choice{coefficients_, kRefinements, options_.seed, options_.threads};
    const SharedLobes lobes = choose_lobes(points, choice, progress_);
    stage("texels", 0.45, 0.5);
    std::vector<std::unique_ptr<TexelSolver>> solver = read_data(lobes);
    stage("texels", 0.5, 1);
    return solved(lobes, solver);
  }

 private:
  std::vector<std::unique_ptr<TexelSolver>> read_data(const SharedLobes& lobes) {
    std::vector<std::unique_ptr<TexelSolver>> solver;
    for (const Relief& relief : relief_) {
      solver.push_back(std::make_unique<TexelSolver>(side_, lobes, relief, options_.threads, progress_));
    }
    std::vector<LevelImages> images;
    for (size_t v = 0; v < side_.view.size(); ++v) {
      progress_.check();
      read_side_view(views_, grid_, side_, v, relief_.size(), images);
      for (size_t l = 0; l < images.size(); ++l) solver[l]->add_view(v, images[l]);
      progress_.update(static_cast<double>(v + 1) / static_cast<double>(side_.view.size()));
    }
    return solver;
  }

  /// Level by level, from one texel to the finest, each from the one before.
  SrbfSide solved(const SharedLobes& lobes, std::vector<std::unique_ptr<TexelSolver>>& solver) {
    SrbfSide side{side_.view_below, side_.light_below, lobes.lobes, lobes.tile_lobes, lobes.lobe, {}, {}};
    side.levels.resize(relief_.size());
    std::vector<std::vector<float>> values(relief_.size());
    RowMatrix start = RowMatrix::Zero(1, static_cast<Eigen::Index>(side.coefficients()));
    for (size_t l = relief_.size(); l-- > 0;) {
      const Relief& relief = relief_[l];
      const int steps = l == 0 ? kSteps : kCoarseSteps;
      // A level costs four times the one before: the finest takes three quarters of the time.
      const double from = std::pow(0.25, static_cast<double>(l + 1)), to = 4 * from;
      const auto after_step = [&](int step) { progress_.update(from + (to - from) * (step + 1) / steps); };
      const RowMatrix value = solver[l]->solve(start, steps, after_step);
      progress_.update(to);  // it may have settled early
      const RowMatrix bright =
          value * brightening(options_.companding, solver[l]->measured(), solver[l]->modelled(value));
      solver[l].reset();
      side.levels[l] = {relief.width(), relief.height(), halves_of(relief.heights()), {}};
      values[l].assign(bright.data(), bright.data() + bright.size());
      if (l > 0) start = refined(value, relief.width(), relief.height(), relief_[l - 1]);
    }
    side.set_values(values);
    return side;
  }

  const TexelGrid& grid_;
  CompandedViews& views_;
  const SideDirections& side_;
  const BtfFitOptions& options_;
  size_t coefficients_;
  Progress& progress_;
  std::vector<Relief> relief_;
};

/// Without those that no light goes through to: what no side shows is black.
std::vector<SideDirections> sides_to_fit(const BtfMeasurement& measurement, CompandedViews& views) {
  std::vector<SideDirections> sides = sides_of(measurement.layout());
  if (sides.size() == 1) return sides;
  std::erase_if(sides, [&](const SideDirections& side) {
    return side.view_below != side.light_below && is_black(views, measurement.grid(), side);
  });
  return sides;
}

}  // namespace

SrbfFit fit_srbf(const BtfMeasurement& measurement, const BtfFitOptions& options, Progress& progress) {
  if (!measurement.layout().complete()) {
    throw Error(Status::unsupported, "A model needs every view under every light; the BTF has " +
                                         std::to_string(measurement.layout().pairs()) + " pairs alone.");
  }
  CompandedViews views(measurement, options.companding, options.threads, progress);
  SrbfFit fit{{measurement.layout(), measurement.grid(), options.companding, Mat3(1.0f), {}}, 0};
  progress.stage("colours", 0, 0.03);
  const std::vector<SideDirections> sides = sides_to_fit(measurement, views);
  const size_t coefficients = coefficients_within(options.bytes, measurement, sides.size());
  fit.btf.axes = views.decorrelate();
  fit.not_finite = views.not_finite();
  const double share = 0.77 / static_cast<double>(sides.size());
  for (size_t s = 0; s < sides.size(); ++s) {
    SideFitter fitter(measurement, views, sides[s], options, coefficients, progress);
    fit.btf.sides.push_back(fitter.fit(0.03 + share * static_cast<double>(s), share));
  }
  return fit;
}

}  // namespace velour
