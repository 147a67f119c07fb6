#include "compress/core_refit.h"

#include <Eigen/Cholesky>

#include "job/parallel.h"

namespace velour {
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
