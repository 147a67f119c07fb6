#include "btf/fit/byte_rounding.h"

#include <Eigen/Cholesky>

namespace velour {
namespace {

constexpr double kRoundingRidge = 1e-6;  // relative to the mean square of a lobe

}  // namespace

Eigen::MatrixXf rounding_moves(const Eigen::MatrixXf& products) {
  Eigen::MatrixXd ridged = products.cast<double>();
  ridged.diagonal().array() += kRoundingRidge * ridged.diagonal().mean();
  const auto n = ridged.rows();
  const Eigen::MatrixXd inverse = ridged.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  Eigen::MatrixXd upper = inverse.llt().matrixU();
  for (Eigen::Index k = 0; k < n; ++k) upper.row(k) /= upper(k, k);
  return upper.cast<float>();
}

void set_rounded(const LobeProductMeans& products, std::vector<std::vector<float>> values, SrbfSide& side) {
  side.set_scale(values);
  const size_t count = side.coefficients();
  size_t first = 0;
  for (size_t a = 0; a < 3; ++a) {
    const size_t end = first + side.lobe[a].size();
    if (end == first) continue;
    const Eigen::MatrixXf moves = rounding_moves(products[a]);
    for (std::vector<float>& level : values) {
      for (size_t texel = 0; texel < level.size(); texel += count) {
        float* const value = level.data() + texel;
        for (size_t k = first; k < end; ++k) {
          const ByteScale& scale = side.scale[k];
          const float error = value[k] - scale.value(scale.nearest(value[k]));
          const auto row = static_cast<Eigen::Index>(k - first);
          for (size_t j = k; j < end; ++j) value[j] -= error * moves(row, static_cast<Eigen::Index>(j - first));
        }
      }
    }
    first = end;
  }
  side.set_values(values);
}

}  // namespace velour
