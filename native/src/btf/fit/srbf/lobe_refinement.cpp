#include "btf/fit/srbf/lobe_refinement.h"

#include <algorithm>
#include <Eigen/Cholesky>
#include "base/aligned_array.h"
#include "base/parallel.h"
#include "math/optimize/lbfgs.h"
#include "math/tensor/matrix_product.h"

namespace velour {

namespace {

/// The numbers of lobes as parameters of a descent, each argument in units of its initial length, so that broad and
/// narrow lobes move alike.
class LobeVectors {
 public:
  explicit LobeVectors(std::vector<MultivariateLobe> lobes) : lobes_(std::move(lobes)) {
    for (MultivariateLobe& lobe : lobes_) {
      for (int a = 0; a < MultivariateLobe::kArguments; ++a) {
        // A zero vector has no slope.
        const int last = std::min(3 * a + 2, MultivariateLobe::kNumbers - 1);
        if (lobe.length(a) == 0) lobe[last] = kBroadest;
        for (int i = 3 * a; i <= last; ++i) unit_.push_back(1 + static_cast<double>(lobe.length(a)));
      }
    }
  }

  Eigen::VectorXd start() {
    Eigen::VectorXd x(static_cast<Eigen::Index>(unit_.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = static_cast<double>(component(lobes_, i)) / unit(i);
    return x;
  }
  std::vector<MultivariateLobe> at(const Eigen::VectorXd& x) const {
    std::vector<MultivariateLobe> lobes = lobes_;
    for (Eigen::Index i = 0; i < x.size(); ++i) component(lobes, i) = static_cast<float>(x[i] * unit(i));
    return lobes;
  }
  Eigen::VectorXd slope(const Eigen::MatrixXd& by_vector) const {
    Eigen::VectorXd slope = Eigen::Map<const Eigen::VectorXd>(by_vector.data(), by_vector.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) slope[i] *= unit(i);
    return slope;
  }

 private:
  static constexpr float kBroadest = 0.05f;
  double unit(Eigen::Index i) const { return unit_[static_cast<size_t>(i)]; }
  static float& component(std::vector<MultivariateLobe>& lobes, Eigen::Index i) {
    const auto number = static_cast<int>(i);
    return lobes[static_cast<size_t>(number / MultivariateLobe::kNumbers)][number % MultivariateLobe::kNumbers];
  }

  std::vector<MultivariateLobe> lobes_;
  std::vector<double> unit_;  // per number
};

}  // namespace

std::vector<MultivariateLobe> refine_lobes(const std::vector<SurfacePoint>& points, std::vector<MultivariateLobe> lobes,
                                           const RefinementOptions& options, Progress& progress) {
  const ProjectedError error(points, options.tile_lobes, options.threads, progress);
  LobeVectors vectors(std::move(lobes));
  Eigen::MatrixXd by_vector;
  const auto f = [&](const Eigen::VectorXd& x, Eigen::VectorXd& slope) {
    const double value = error(vectors.at(x), by_vector);
    slope = vectors.slope(by_vector);
    return value;
  };
  LbfgsOptions descent;
  descent.steps = options.steps;
  const auto after_step = [&](int step) { progress.update(static_cast<double>(step + 1) / options.steps); };
  return vectors.at(descend_lbfgs(f, vectors.start(), descent, after_step));
}

namespace {

constexpr float kTileRidge = 1e-5f;  // on coefficients, relative to a lobe of value 1 everywhere

/// Solves gram x = moment. `gram` (symmetric; its lower half is read) may be singular up to rounding.
Eigen::VectorXf solved(const Eigen::MatrixXf& gram, const Eigen::VectorXf& moment) {
  const Eigen::LLT<Eigen::MatrixXf> factor(gram);  // in blocks: several times as fast as LDLT
  if (factor.info() == Eigen::Success) return factor.solve(moment);
  return gram.selfadjointView<Eigen::Lower>().ldlt().solve(moment);
}

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
  const Eigen::VectorXf coefficient = solved(gram, column.transpose() * truth);
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

RowMatrix LobeValues::at(const SurfacePoint& point, size_t pairs) const {
  const size_t count = std::min(pairs, point.pair.size());
  RowMatrix values(static_cast<Eigen::Index>(count), tile_.size() + texel_.size());
  AlignedArray<float> row(std::max(tile_.padded(), texel_.padded()));
  for (size_t i = 0; i < count; ++i) {
    float* const to = values.row(static_cast<Eigen::Index>(i)).data();
    tile_.values(point.pair[i], row.data());
    std::copy_n(row.data(), tile_.size(), to);
    texel_.values(point.pair[i].turned(point.to_normal), row.data());
    std::copy_n(row.data(), texel_.size(), to + tile_.size());
  }
  return values;
}

}  // namespace velour
