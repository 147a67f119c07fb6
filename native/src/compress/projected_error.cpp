#include "compress/projected_error.h"

#include <Eigen/Cholesky>

#include "compress/lobe_values.h"
#include "job/parallel.h"
#include "tensor/matrix_product.h"

namespace velour {
namespace {

constexpr float kTileRidge = 1e-5f;  // on coefficients, relative to a lobe of value 1 everywhere

}  // namespace

struct ProjectedError::Part {
  double error = 0;
  Eigen::MatrixXf slope;  // number x lobe
};

ProjectedError::ProjectedError(const std::vector<SurfacePoint>& points, uint32_t tile_lobes, int threads,
                               const Progress& progress)
    : points_(points), tile_lobes_(tile_lobes), threads_(threads), progress_(progress) {
  for (const SurfacePoint& point : points) {
    auto& of_point = argument_.emplace_back();
    for (size_t frame = 0; frame < 2; ++frame) {
      of_point[frame].resize(MultivariateLobe::kNumbers, static_cast<Eigen::Index>(point.pair.size()));
      for (size_t i = 0; i < point.pair.size(); ++i) {
        const LobeArguments at = frame == 0 ? point.pair[i] : point.pair[i].turned(point.to_normal);
        for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
          of_point[frame](k, static_cast<Eigen::Index>(i)) = at[k];
        }
      }
    }
  }
}

double ProjectedError::operator()(const std::vector<MultivariateLobe>& lobes, Eigen::MatrixXd& slope) const {
  const LobeValues values(lobes, tile_lobes_);
  std::vector<Part> part(points_.size());
  parallel_pieces(points_.size(), threads_, progress_, [&](size_t i) { part[i] = of_point(i, lobes, values); });
  slope.setZero(MultivariateLobe::kNumbers, static_cast<Eigen::Index>(lobes.size()));
  double error = 0;
  for (const Part& p : part) {  // in order: the same bits for any number of threads
    error += p.error;
    slope += p.slope.cast<double>();
  }
  return error;
}

ProjectedError::Part ProjectedError::of_point(size_t number, const std::vector<MultivariateLobe>& lobes,
                                              const LobeValues& values) const {
  const SurfacePoint& point = points_[number];
  const auto count = static_cast<Eigen::Index>(lobes.size());
  Part part{0, Eigen::MatrixXf::Zero(MultivariateLobe::kNumbers, count)};
  if (point.pair.empty()) return part;
  const Eigen::MatrixXf column = values.at(point, point.pair.size());
  const Eigen::Map<const Eigen::VectorXf> truth(point.value[0].data(), column.rows());
  const float ridge = kTileRidge * static_cast<float>(column.rows());
  Eigen::MatrixXf gram(count, count);
  multiply_by_itself({column.data(), count, column.rows(), column.rows(), 1}, {gram.data(), count, count, 1, count});
  gram.diagonal().array() += ridge;
  const Eigen::VectorXf coefficient =
      gram.selfadjointView<Eigen::Lower>().ldlt().solve(column.transpose() * truth).eval();
  const Eigen::VectorXf rest = truth - column * coefficient;
  part.error = static_cast<double>(rest.squaredNorm() + ridge * coefficient.squaredNorm());
  // At the best coefficients the error does not change with them: only the change of the lobes remains.
  const Eigen::MatrixXf weight = (column.array().colwise() * rest.array()).matrix();
  const auto tile = static_cast<Eigen::Index>(tile_lobes_);
  part.slope.leftCols(tile) = argument_[number][0] * weight.leftCols(tile);
  part.slope.rightCols(count - tile) = argument_[number][1] * weight.rightCols(count - tile);
  for (Eigen::Index j = 0; j < count; ++j) {
    const float total = weight.col(j).sum();
    const MultivariateLobe& lobe = lobes[static_cast<size_t>(j)];
    for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
      const float length = lobe.length(k / 3);
      if (length > 0) part.slope(k, j) -= total * lobe[k] / length;
    }
    part.slope.col(j) *= -2 * coefficient[j];
  }
  return part;
}

}  // namespace velour
