#include "compress/function_refit.h"

#include <Eigen/Cholesky>
#include <numeric>

#include "compress/core_refit.h"
#include "job/parallel.h"
#include "tensor/decompositions.h"

namespace velour {
namespace {

constexpr double kFunctionRidge = 1e-5;  // relative to the mean diagonal

Eigen::MatrixXd sum_of(std::vector<Eigen::MatrixXd>& groups) {
  for (size_t g = 1; g < groups.size(); ++g) groups[0] += groups[g];
  return std::move(groups[0]);
}

/// Solves A x = b for a symmetric A that may be singular; x stays near `start` where A does not determine it.
Eigen::MatrixXd solved_near(Eigen::MatrixXd matrix, const Eigen::MatrixXd& right, const Eigen::MatrixXd& start) {
  const double ridge = kFunctionRidge * matrix.trace() / static_cast<double>(matrix.rows());
  if (!(ridge > 0)) return start;
  matrix.diagonal().array() += ridge;
  return matrix.llt().solve(right + ridge * start);
}

/// Orthonormalizes the columns. Returns the matrix that maps the new columns to the old ones.
RowMatrix orthonormalised(RowMatrix& factor) {
  QrParts parts = qr_parts(factor);
  factor = std::move(parts.basis);
  return std::move(parts.triangle);
}

class FunctionRefit {
 public:
  FunctionRefit(const std::vector<ViewMoments>& moments, int threads, const Progress& progress,
                std::vector<DirectionCluster>& clusters)
      : moments_(moments), threads_(threads), progress_(progress), cluster_(clusters), rank_(clusters[0].rank()) {}

  double value() const {
    std::vector<double> part(moments_.size());
    parallel_pieces(part.size(), threads_, progress_, [&](size_t v) {
      const FunctionsOfView f = functions_of_view(cluster_, static_cast<Index>(v));
      for (size_t a = 0; a < 3; ++a) {
        const RowMatrix half = 0.5f * (moments_[v].products * f[a]) - moments_[v].images[a];
        part[v] += 2 * f[a].cast<double>().cwiseProduct(half.cast<double>()).sum();
      }
    });
    return std::accumulate(part.begin(), part.end(), 0.0);
  }

  void solve_lights();
  void solve_views();
  void make_orthonormal();

 private:
  Index count() const { return static_cast<Index>(cluster_.size()) * rank_; }
  RowMatrix of_lights(Index view, size_t axis) const;
  std::vector<RowMatrix> of_view_ranks() const;
  Eigen::VectorXd solved_view(size_t view, const std::vector<RowMatrix>& parts) const;

  const std::vector<ViewMoments>& moments_;
  int threads_;
  const Progress& progress_;
  std::vector<DirectionCluster>& cluster_;
  Index rank_;
};

/// Functions of a view are this matrix times rows of the light factors: [cluster, rank] x [cluster, light rank].
RowMatrix FunctionRefit::of_lights(Index view, size_t axis) const {
  const Index lights = cluster_[0].light.cols(), colors = cluster_[0].color.cols(), views = cluster_[0].view.cols();
  RowMatrix all = RowMatrix::Zero(count(), static_cast<Index>(cluster_.size()) * lights);
  for (size_t c = 0; c < cluster_.size(); ++c) {
    const DirectionCluster& of = cluster_[c];
    for (Index r = 0; r < rank_; ++r) {
      const Eigen::RowVectorXf mixed = of.view.row(view) * of.core.middleRows(r * views, views);
      all.row(static_cast<Index>(c) * rank_ + r).segment(static_cast<Index>(c) * lights, lights) =
          (Eigen::Map<const RowMatrix>(mixed.data(), lights, colors) *
           of.color.row(static_cast<Index>(axis)).transpose())
              .transpose();
    }
  }
  return all;
}

/// The matrix is the same for all lights.
void FunctionRefit::solve_lights() {
  const Index ranks = cluster_[0].light.cols(), all = static_cast<Index>(cluster_.size()) * ranks,
              lights = cluster_[0].light.rows();
  if (all > kMostJointRanks) return;
  std::vector<Eigen::MatrixXd> matrix(kMomentGroups, Eigen::MatrixXd::Zero(all, all)),
      right(kMomentGroups, Eigen::MatrixXd::Zero(all, lights));
  parallel_pieces(kMomentGroups, threads_, progress_, [&](size_t g) {
    for (size_t v = g; v < moments_.size(); v += kMomentGroups) {
      for (size_t a = 0; a < 3; ++a) {
        const RowMatrix of = of_lights(static_cast<Index>(v), a);
        matrix[g] += (of.transpose() * (moments_[v].products * of)).cast<double>();
        right[g] += (of.transpose() * moments_[v].images[a]).cast<double>();
      }
    }
  });
  Eigen::MatrixXd start(all, lights);
  for (size_t c = 0; c < cluster_.size(); ++c) {
    start.middleRows(static_cast<Index>(c) * ranks, ranks) = cluster_[c].light.transpose().cast<double>();
  }
  const Eigen::MatrixXd solution = solved_near(sum_of(matrix), sum_of(right), start);
  for (size_t c = 0; c < cluster_.size(); ++c) {
    cluster_[c].light = solution.middleRows(static_cast<Index>(c) * ranks, ranks).transpose().cast<float>();
  }
}

/// The functions of a view are sums of these parts, weighted by a row of the view factors: per cluster and view rank,
/// [texel rank] x [axis, light].
std::vector<RowMatrix> FunctionRefit::of_view_ranks() const {
  const Index views = cluster_[0].view.cols(), lights = cluster_[0].light.rows();
  std::vector<RowMatrix> parts(cluster_.size() * static_cast<size_t>(views), RowMatrix(rank_, 3 * lights));
  parallel_pieces(parts.size(), threads_, progress_, [&](size_t n) {
    const DirectionCluster& of = cluster_[n / static_cast<size_t>(views)];
    for (Index r = 0; r < rank_; ++r) {
      const Eigen::RowVectorXf row = of.core.row(r * views + static_cast<Index>(n) % views);
      const Eigen::Map<const RowMatrix> core(row.data(), of.light.cols(), of.color.cols());
      const RowMatrix values = of.color * (of.light * core).transpose();
      parts[n].row(r) = Eigen::Map<const Eigen::RowVectorXf>(values.data(), values.size());
    }
  });
  return parts;
}

/// Solves for the view's rows of all clusters' factors.
Eigen::VectorXd FunctionRefit::solved_view(size_t view, const std::vector<RowMatrix>& parts) const {
  const ViewMoments& moments = moments_[view];
  const Index views = cluster_[0].view.cols(), lights = cluster_[0].light.rows(),
              all = static_cast<Index>(parts.size());
  Eigen::MatrixXd matrix(all, all);
  Eigen::VectorXd right(all), start(all);
  for (Index n = 0; n < all; ++n) {
    const Index c = n / views;
    const RowMatrix& part = parts[static_cast<size_t>(n)];
    start[n] = static_cast<double>(cluster_[static_cast<size_t>(c)].view(static_cast<Index>(view), n % views));
    right[n] = 0;
    for (Index a = 0; a < 3; ++a) {
      const RowMatrix& images = moments.images[static_cast<size_t>(a)];
      right[n] += static_cast<double>(
          images.middleRows(c * rank_, rank_).cwiseProduct(part.middleCols(a * lights, lights)).sum());
    }
    for (Index d = 0; d <= c; ++d) {
      const RowMatrix turned = moments.products.block(d * rank_, c * rank_, rank_, rank_) * part;
      for (Index m = d * views; m < (d + 1) * views; ++m) {
        const float product = turned.cwiseProduct(parts[static_cast<size_t>(m)]).sum();
        matrix(n, m) = matrix(m, n) = static_cast<double>(product);
      }
    }
  }
  return solved_near(matrix, right, start);
}

void FunctionRefit::solve_views() {
  const Index views = cluster_[0].view.cols();
  if (static_cast<Index>(cluster_.size()) * views > kMostJointRanks) return;
  const std::vector<RowMatrix> parts = of_view_ranks();
  std::vector<Eigen::VectorXd> solution(moments_.size());
  parallel_pieces(moments_.size(), threads_, progress_, [&](size_t v) { solution[v] = solved_view(v, parts); });
  for (size_t v = 0; v < moments_.size(); ++v) {
    for (size_t c = 0; c < cluster_.size(); ++c) {
      cluster_[c].view.row(static_cast<Index>(v)) =
          solution[v].segment(static_cast<Index>(c) * views, views).transpose().cast<float>();
    }
  }
}

/// Orthonormalizes the factors; the cores absorb the change.
void FunctionRefit::make_orthonormal() {
  for (DirectionCluster& of : cluster_) {
    const Index views = of.view.cols(), lights = of.light.cols(), colors = of.color.cols();
    const RowMatrix view = orthonormalised(of.view), light = orthonormalised(of.light);
    for (Index r = 0; r < rank_; ++r) {
      of.core.middleRows(r * views, views) = view * of.core.middleRows(r * views, views);
    }
    for (Index r = 0; r < of.core.rows(); ++r) {
      Eigen::Map<RowMatrix> core(of.core.row(r).data(), lights, colors);
      core = light * RowMatrix(core);
    }
  }
}

}  // namespace

std::vector<double> refit_functions(const std::vector<ViewMoments>& moments, const RefitOptions& options,
                                    const Progress& progress, std::vector<DirectionCluster>& clusters) {
  FunctionRefit refit(moments, options.threads, progress, clusters);
  std::vector<double> value{refit.value()};
  for (int round = 0; round < options.rounds; ++round) {
    refit.solve_lights();
    value.push_back(refit.value());
    refit.solve_views();
    value.push_back(refit.value());
    refit.make_orthonormal();
    refit_cores(moments, options.threads, progress, clusters);
    value.push_back(refit.value());
  }
  return value;
}

}  // namespace velour
