// Loops over the samples of a slice: kernel columns, their derivatives, Gram matrices, residuals. SIMD through Highway
// with run-time dispatch. Columns are float; a block is summed in float lanes, and blocks are summed in double in a
// fixed order.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "brdf/fit/slice_sampling.h"
#include "math/srbf/kernel.h"

namespace velour {

/// The shape of a lobe in the solver: peak 1 at `center` (unit), and `sharpness` k = -dS/dd there, d = 1 - eta .
/// center. Gaussian: S = exp(-k d), k the bandwidth. Abel-Poisson: S = (1 + 2/3 k d)^(-3/2), the kernel over its peak
/// with 2/3 k = 2 b / (1 - b)^2. One scale, log k, thus serves both kernels and needs no bounds.
struct LobeShape {
  Vec3d center{0, 0, 1};
  double sharpness = 1;
};

/// Columns of `padded` floats each, contiguous.
class ColumnSet {
 public:
  explicit ColumnSet(size_t padded) : padded_(padded) {}
  void resize(size_t columns) { data_.resize(columns * padded_); }
  float* operator[](size_t column) { return data_.data() + column * padded_; }
  const float* operator[](size_t column) const { return data_.data() + column * padded_; }
  /// Pointers to the first `count` columns.
  std::vector<const float*> first(size_t count) const {
    std::vector<const float*> out(count);
    for (size_t j = 0; j < count; ++j) out[j] = (*this)[j];
    return out;
  }

 private:
  size_t padded_;
  AlignedFloats data_;
};

/// out_i = sqrt(weight_i) S(wl_i).
void fill_value(Kernel kernel, const LobeShape& shape, const SliceSamples& samples, float* out);

/// Tangents for fill_derivatives (unit, normal to the center). It fills the derivatives of fill_value's column along
/// each tangent, for a turn of 1 / sqrt(sharpness) radians, and by log sharpness.
struct LobeTangents {
  Vec3d x, y;
};
LobeTangents lobe_tangents(const LobeShape& shape);
void fill_derivatives(Kernel kernel, const LobeShape& shape, const SliceSamples& samples, float* along_x,
                      float* along_y, float* by_log_sharpness);

/// Dot products of the column of a shape with each channel's residual, and with itself.
struct Projection {
  double moment[3];
  double norm_sq;
};
Projection project(Kernel kernel, const LobeShape& shape, const SliceSamples& samples, const float* const residual[3]);

/// All dot products of `columns` with one another (symmetric, both triangles filled).
void gram(std::span<const float* const> columns, size_t padded, Eigen::MatrixXd& out);

/// out(i, j) = rows_i . columns_j.
void cross_gram(std::span<const float* const> rows, std::span<const float* const> columns, size_t padded,
                Eigen::MatrixXd& out);

/// residual_c = target_c - sum_j coefficients(j, c) column_j, of three channels c.
void subtract_columns(std::span<const float* const> columns, const Eigen::MatrixXd& coefficients,
                      const float* const target[3], size_t padded, float* const residual[3]);

}  // namespace velour
