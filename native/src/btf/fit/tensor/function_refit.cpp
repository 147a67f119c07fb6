#include "btf/fit/tensor/function_refit.h"

#include <Eigen/Cholesky>
#include <numeric>
#include "base/parallel.h"
#include "math/tensor/decompositions.h"

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
RowMatrix orthonormalized(RowMatrix& factor) {
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
  if (all > kMaxJointRanks) return;
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
  if (static_cast<Index>(cluster_.size()) * views > kMaxJointRanks) return;
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
    const RowMatrix view = orthonormalized(of.view), light = orthonormalized(of.light);
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

namespace {

constexpr int kCoreSteps = 12;
constexpr double kCoreConverged = 1e-8;  // relative to the initial squared residual
constexpr double kCoreRidge = 1e-5;      // relative to the mean diagonal: keeps cores that few texels use as they are
constexpr double kMinDiagonal = 1e-30;

using Cores = std::vector<RowMatrix>;

double dot(const Cores& a, const Cores& b) {
  double sum = 0;
  for (size_t c = 0; c < a.size(); ++c) sum += a[c].cast<double>().cwiseProduct(b[c].cast<double>()).sum();
  return sum;
}

void add(float factor, const Cores& b, Cores& to) {
  for (size_t c = 0; c < to.size(); ++c) to[c] += factor * b[c];
}

class CoreRefit {
 public:
  CoreRefit(const std::vector<ViewMoments>& moments, int threads, const Progress& progress,
            std::vector<DirectionCluster>& clusters)
      : moments_(moments), threads_(threads), progress_(progress), cluster_(clusters), rank_(clusters[0].rank()) {
    double trace = 0;
    for (const ViewMoments& of : moments) trace += of.products.diagonal().cast<double>().sum();
    ridge_ = kCoreRidge * trace / static_cast<double>(moments.size() * clusters.size()) / static_cast<double>(rank_);
  }

  void solve();

 private:
  template <class Use>
  Cores summed(const Use& use) const;
  void project(size_t view, size_t axis, const RowMatrix& values, Cores& to) const;
  Cores gradient() const;
  Cores product(const Cores& direction) const;
  std::vector<Eigen::MatrixXf> inverse_means() const;

  const std::vector<ViewMoments>& moments_;
  int threads_;
  const Progress& progress_;
  std::vector<DirectionCluster>& cluster_;
  Index rank_;
  double ridge_;
};

/// Sums over views in a fixed number of groups.
template <class Use>
Cores CoreRefit::summed(const Use& use) const {
  std::vector<Cores> group(kMomentGroups);
  parallel_pieces(kMomentGroups, threads_, progress_, [&](size_t g) {
    for (const DirectionCluster& c : cluster_) group[g].push_back(RowMatrix::Zero(c.core.rows(), c.core.cols()));
    for (size_t v = g; v < moments_.size(); v += kMomentGroups) use(v, group[g]);
  });
  for (size_t g = 1; g < kMomentGroups; ++g) add(1, group[g], group[0]);
  return std::move(group[0]);
}

/// Adds the projection of `values`, [cluster, rank][light] of an axis, onto the cores' factors.
void CoreRefit::project(size_t view, size_t axis, const RowMatrix& values, Cores& to) const {
  for (size_t c = 0; c < cluster_.size(); ++c) {
    const DirectionCluster& of = cluster_[c];
    const Index views = of.view.cols(), lights = of.light.cols(), colors = of.color.cols();
    const RowMatrix turned = values.middleRows(static_cast<Index>(c) * rank_, rank_) * of.light;
    for (Index r = 0; r < rank_; ++r) {
      RowMatrix row(lights, colors);
      row.noalias() = turned.row(r).transpose() * of.color.row(static_cast<Index>(axis));
      to[c].middleRows(r * views, views).noalias() += of.view.row(static_cast<Index>(view)).transpose() *
                                                      Eigen::Map<const Eigen::RowVectorXf>(row.data(), row.size());
    }
  }
}

Cores CoreRefit::gradient() const {
  return summed([&](size_t v, Cores& to) {
    const FunctionsOfView f = functions_of_view(cluster_, static_cast<Index>(v));
    for (size_t a = 0; a < 3; ++a) project(v, a, moments_[v].images[a] - moments_[v].products * f[a], to);
  });
}

Cores CoreRefit::product(const Cores& direction) const {
  std::vector<DirectionCluster> turned = cluster_;
  for (size_t c = 0; c < turned.size(); ++c) turned[c].core = direction[c];
  Cores sums = summed([&](size_t v, Cores& to) {
    const FunctionsOfView f = functions_of_view(turned, static_cast<Index>(v));
    for (size_t a = 0; a < 3; ++a) project(v, a, moments_[v].products * f[a], to);
  });
  add(static_cast<float>(ridge_), direction, sums);
  return sums;
}

/// Preconditioner: the inverse of each cluster's mean products, near that of the normal matrix if factors are
/// orthonormal.
std::vector<Eigen::MatrixXf> CoreRefit::inverse_means() const {
  std::vector<Eigen::MatrixXf> inverse;
  for (size_t c = 0; c < cluster_.size(); ++c) {
    const Index first = static_cast<Index>(c) * rank_;
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(rank_, rank_);
    for (const ViewMoments& of : moments_) mean += of.products.block(first, first, rank_, rank_).cast<double>();
    mean /= static_cast<double>(moments_.size());
    mean.diagonal().array() += ridge_ + kMinDiagonal;
    inverse.push_back(mean.llt().solve(Eigen::MatrixXd::Identity(rank_, rank_)).cast<float>());
  }
  return inverse;
}

void CoreRefit::solve() {
  const std::vector<Eigen::MatrixXf> inverse = inverse_means();
  const auto conditioned = [&](Cores rest) {
    for (size_t c = 0; c < rest.size(); ++c) {
      Eigen::Map<RowMatrix> rows(rest[c].data(), rank_, rest[c].size() / rank_);
      rows = inverse[c] * RowMatrix(rows);
    }
    return rest;
  };
  Cores rest = gradient(), direction = conditioned(rest);
  double energy = dot(rest, direction);
  const double settled = kCoreConverged * energy;
  for (int step = 0; step < kCoreSteps && energy > settled; ++step) {
    const Cores moved = product(direction);
    const auto length = static_cast<float>(energy / dot(direction, moved));
    for (size_t c = 0; c < cluster_.size(); ++c) cluster_[c].core += length * direction[c];
    add(-length, moved, rest);
    const Cores turned = conditioned(rest);
    const double now = dot(rest, turned);
    for (RowMatrix& d : direction) d *= static_cast<float>(now / energy);
    add(1, turned, direction);
    energy = now;
  }
}

}  // namespace

void refit_cores(const std::vector<ViewMoments>& moments, int threads, const Progress& progress,
                 std::vector<DirectionCluster>& clusters) {
  CoreRefit(moments, threads, progress, clusters).solve();
}

}  // namespace velour
