// Solver for the coefficients of all texels with given lobes, level by level.
#pragma once

#include <cstdint>
#include <functional>
#include "btf/fit/byte_rounding.h"
#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/side_views.h"
#include "btf/fit/srbf/srbf_fit.h"
#include "btf/measure/relief.h"
#include "btf/model/srbf_btf.h"

namespace velour {

// Products of a small matrix, row by row, with three vectors: the inner loop of a texel's solve.

/// `rows`: [count][stride], stride a multiple of 16, aligned to 64 bytes, as are all arrays here.
/// value[3 i + a] = row i . coefficient[a], where coefficient is [3][stride].
void rows_times(const float* rows, uint32_t count, uint32_t stride, const float* coefficient, float* value);

/// sum[a][k] = sum over i of rows[i][k] value[3 i + a].
void times_rows(const float* rows, uint32_t count, uint32_t stride, const float* value, float* sum);

// Solver for the coefficients of all texels of a level with given lobes.

/// Least squares over every pair and texel of a level: a value is the sum of lobes with coefficients interpolated where
/// the view ray hits the relief. Neighbors are therefore coupled, and all texels are solved for together, by conjugate
/// gradients ([HS52]) in coordinates in which lobes are orthonormal on average. The normal matrix is never stored; its
/// products need only the directions, so data are read once.
class TexelSolver {
 public:
  TexelSolver(const SideDirections& side, const SharedLobes& lobes, const Relief& relief, int threads,
              const Progress& progress);

  /// Call once per view.
  void add_view(size_t view, const LevelImages& images);

  /// Returns [texel][coefficient]; `start` has the same shape.
  RowMatrix solve(const RowMatrix& start, int steps, const std::function<void(int)>& after_step);

  /// Mean products of lobes on this level.
  const LobeProductMeans& products() const { return products_; }

  /// Sums of squares over sampled texels of every view and all lights, times both cosines: of the data, and of a
  /// solution.
  double measured() const { return measured_; }
  double modelled(const RowMatrix& solution) const;

 private:
  struct Place;  // where a view ray hits the relief
  std::vector<Place> places(size_t view) const;
  std::vector<size_t> sample(size_t view) const;
  static Eigen::RowVectorXf blended(const RowMatrix& coefficient, const Place& place);
  void write_rows(size_t view, const Place& place, float* rows) const;
  template <class Values>
  void accumulate(size_t view, const Values& values_of, RowMatrix& sums) const;
  RowMatrix normal_product(const RowMatrix& coefficient) const;
  RowMatrix whitened(const RowMatrix& m) const;
  size_t add_products(size_t view, Eigen::MatrixXd& sum) const;
  void set_coordinates();
  void spread(const float* compact, float* padded) const;
  void gather(const float* padded, float* compact) const;

  const SideDirections& side_;
  const SharedLobes& lobes_;
  const Relief& relief_;
  int threads_;
  const Progress& progress_;
  MultivariateLobes tile_, texel_;
  uint32_t stride_;                        // padded length of a row of lobes
  std::vector<uint32_t> column_;           // place of each coefficient in [axis][padded lobe]
  LobeProductMeans products_;              // with a ridge
  std::array<Eigen::MatrixXf, 3> whiten_;  // symmetric: inverse roots of the axes' Gram matrices
  RowMatrix data_;                         // moments of the data with each coefficient's function
  double measured_ = 0;
};

// Solves for the texels of a side level by level.

struct TexelLevelsInput {
  const TexelGrid& grid;
  const SideDirections& side;
  const std::vector<Relief>& relief;  // per level, finest first
  const SharedLobes& lobes;
  Companding companding;
  int threads;
};

/// Sets the levels of `side`, which has the input's lobes, from one texel to the finest level, each from the coarser
/// one. Reads every view once, unless the checkpoint has all levels under `stage`. Progress covers the stage.
void solve_levels(CompandedViews& views, const TexelLevelsInput& input, FitCheckpoint& checkpoint,
                  const std::string& stage, Progress& progress, SrbfSide& side);

}  // namespace velour
