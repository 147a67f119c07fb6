#include "math/tensor/cluster_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include "base/error.h"
#include "base/parallel.h"
#include "math/sphere/random.h"
#include "math/tensor/cluster_choice.h"
#include "math/tensor/decompositions.h"
#include "math/tensor/matrix_product.h"
#include "math/tensor/tensor_view.h"

namespace velour {

namespace {

[[noreturn]] void wrong(const std::string& what) { throw Error(Status::invalid_argument, what); }

/// Number of slices that a restarted cluster begins with: half the average.
Index fair_share(Index slices, Index clusters) { return std::max<Index>(1, slices / (2 * clusters)); }

class ClusterSolver {
 public:
  ClusterSolver(const TensorView& slices, const ClusterOptions& options, const Progress& progress)
      : matrix_(slices.data(), {slices.extent(0), slices.size() / slices.extent(0)}),
        options_(options),
        progress_(progress) {
    tensor_.extent = slices.extents();
    for (Index i = 0; i < matrix_.extent(0); ++i) {
      const Eigen::Map<const Eigen::VectorXf> slice(matrix_.data() + i * matrix_.extent(1), matrix_.extent(1));
      square_.push_back(static_cast<double>(slice.squaredNorm()));
      if (!std::isfinite(square_.back())) {
        wrong("Slice " + std::to_string(i) +
              " contains values that are not finite or too large. Remove or correct them.");
      }
    }
  }

  double square() const { return std::accumulate(square_.begin(), square_.end(), 0.0); }

  void start() {
    tensor_.cluster.resize(static_cast<size_t>(options_.clusters));
    basis_.resize(tensor_.cluster.size());
    const std::vector<uint32_t> of = clusters_by_direction(coordinates(), options_.clusters, options_.tensor.seed);
    for (uint32_t c = 0; c < tensor_.cluster.size(); ++c) {
      std::vector<Index> mine;
      for (size_t i = 0; i < of.size(); ++i) {
        if (of[i] == c) mine.push_back(static_cast<Index>(i));
      }
      if (mine.empty()) mine.push_back(static_cast<Index>(c) % matrix_.extent(0));
      fit_cluster(c, rests(mine, c));
    }
  }

  /// Fits with one more member per slice than before; appends the squared error after every step to `error`.
  void alternate(Index members, std::vector<double>& error) {
    tensor_.members = members;
    tensor_.coefficient.resize(0, 0);
    error.push_back(square() - choose().after);
    for (int i = 0; i < options_.iterations; ++i) {
      const double before = error.back();
      for (uint32_t c = 0; c < tensor_.cluster.size(); ++c) {
        progress_.check();
        update(c);
      }
      const KeptSquares kept = choose();
      error.push_back(square() - kept.before);
      error.push_back(square() - kept.after);
      if (!(before - error.back() > options_.tolerance * square())) break;
    }
  }

  ClusteredTensor take() { return std::move(tensor_); }

 private:
  RowMatrix coordinates() const {
    const Index rank = std::min<Index>({2 * options_.ranks[0], matrix_.extent(0), matrix_.extent(1)});
    if (options_.coordinates == nullptr) return slice_coordinates(matrix_, rank, options_.tensor, progress_);
    return options_.coordinates->leftCols(std::min(rank, options_.coordinates->cols()));
  }

  KeptSquares choose() {
    return choose_members(ClusterProducts(matrix_, basis_, options_.tensor, progress_), tensor_, options_.tensor,
                          progress_);
  }

  /// Empty before the first choice.
  std::span<uint32_t> members_of(Index slice) {
    if (tensor_.member.empty()) return {};
    const auto members = static_cast<size_t>(tensor_.members);
    return {tensor_.member.data() + static_cast<size_t>(slice) * members, members};
  }

  DenseTensor rests(std::span<const Index> which, uint32_t but) {
    return cluster_rests(matrix_, tensor_, basis_, which, but, options_.tensor, progress_);
  }

  void update(uint32_t c) {
    std::vector<Index> mine;
    for (Index i = 0; i < matrix_.extent(0); ++i) {
      const std::span<uint32_t> member = members_of(i);
      if (std::find(member.begin(), member.end(), c) != member.end()) mine.push_back(i);
    }
    if (mine.empty()) {
      tensor_.cluster[c].factor.clear();
      return fit_cluster(c, rests(worst_off(), c));
    }
    const DenseTensor data = rests(mine, c);
    fit_cluster(c, data);
    const DenseTensor coefficient = mode_product(data.view(), 1, basis_[c], options_.tensor.threads, progress_);
    const Index rank = tensor_.rank();
    for (size_t i = 0; i < mine.size(); ++i) {
      const std::span<uint32_t> member = members_of(mine[i]);
      const Index k = std::find(member.begin(), member.end(), c) - member.begin();
      tensor_.coefficient.row(mine[i]).segment(k * rank, rank) =
          Eigen::Map<const Eigen::RowVectorXf>(coefficient.data.data() + static_cast<Index>(i) * rank, rank);
    }
  }

  std::vector<Index> worst_off() {
    std::vector<Index> all(square_.size());
    std::iota(all.begin(), all.end(), Index{0});
    const DenseTensor rest = rests(all, static_cast<uint32_t>(basis_.size()));
    std::vector<float> error;
    for (const Index i : all) {
      error.push_back(
          Eigen::Map<const Eigen::VectorXf>(rest.data.data() + i * rest.extent[1], rest.extent[1]).squaredNorm());
    }
    std::stable_sort(all.begin(), all.end(),
                     [&](Index a, Index b) { return error[static_cast<size_t>(a)] > error[static_cast<size_t>(b)]; });
    all.resize(static_cast<size_t>(fair_share(matrix_.extent(0), options_.clusters)));
    std::sort(all.begin(), all.end());
    return all;
  }

  /// `rests`: residuals of its slices without it.
  void fit_cluster(uint32_t c, const DenseTensor& rests) {
    TensorCluster& cluster = tensor_.cluster[c];
    std::vector<Index> extent = tensor_.extent, ranks;
    extent[0] = rests.extent[0];
    for (size_t mode = 0; mode < extent.size(); ++mode) ranks.push_back(std::min(options_.ranks[mode], extent[mode]));
    const TensorView data(rests.data.data(), extent);
    Tucker tucker;
    if (cluster.factor.empty()) {
      tucker = truncated_hosvd(data, ranks, options_.tensor, progress_);
    } else {
      tucker.factor = cluster.factor;
      // The sweep computes this factor first, so only its number of columns matters.
      tucker.factor.insert(tucker.factor.begin(), RowMatrix::Zero(ranks[0], ranks[0]));
      hooi_sweep(data, tucker, options_.tensor, progress_);
    }
    const Index others = static_cast<Index>(tucker.core.data.size()) / ranks[0];
    const RowMatrix core = Eigen::Map<const RowMatrix>(tucker.core.data.data(), ranks[0], others);
    cluster.factor.assign(tucker.factor.begin() + 1, tucker.factor.end());
    cluster.core = RowMatrix::Zero(options_.ranks[0], others);  // rows beyond the number of slices stay 0
    cluster.core.topRows(ranks[0]) = orthonormal(core.transpose()).transpose();
    basis_[c] = cluster.basis(options_.tensor, progress_);
  }

  TensorView matrix_;
  ClusterOptions options_;
  const Progress& progress_;
  ClusteredTensor tensor_;
  std::vector<RowMatrix> basis_;
  std::vector<double> square_;  // squared norm of each slice
};

void check(const TensorView& slices, const ClusterOptions& options) {
  if (options.ranks.size() != slices.order()) wrong("A tensor must have one rank per mode.");
  Index others = 1;
  for (size_t mode = 1; mode < slices.order(); ++mode) {
    others *= std::min(options.ranks[mode], slices.extent(mode));
  }
  if (options.ranks[0] > others) {
    wrong("The rank of the slices is " + std::to_string(options.ranks[0]) +
          ", more than the product of the other ranks, " + std::to_string(others) +
          ". Increase the ranks of the other modes.");
  }
  if (options.clusters < 1 || options.members < 1 || options.members > options.clusters) {
    wrong(std::to_string(options.members) + " members of " + std::to_string(options.clusters) +
          " clusters are invalid: both must be at least 1, and there cannot be more members than clusters.");
  }
}

}  // namespace

ClusterFit fit_clusters(const TensorView& slices, const ClusterOptions& options, Progress& progress) {
  check(slices, options);
  ClusterSolver solver(slices, options, progress);
  solver.start();
  std::vector<double> error;
  for (Index members = 1; members <= options.members; ++members) solver.alternate(members, error);
  progress.update(1);
  return {solver.take(), solver.square(), std::move(error)};
}

namespace {

constexpr Index kRestColumns = 1024;  // per piece of work

/// The slices that have a given cluster as a member.
struct Group {
  std::vector<Index> place;  // rows in the result
  RowMatrix coefficient;     // [place][rank]
};

std::vector<Group> grouped(const ClusteredTensor& tensor, std::span<const Index> which, uint32_t but) {
  std::vector<Group> groups(tensor.cluster.size());
  if (tensor.member.empty()) return groups;
  const auto member = [&](size_t place, Index k) {
    return tensor.member[static_cast<size_t>(which[place] * tensor.members + k)];
  };
  const auto for_others = [&](const auto& use) {
    for (size_t place = 0; place < which.size(); ++place) {
      for (Index k = 0; k < tensor.members; ++k) {
        if (member(place, k) != but) use(place, k, groups[member(place, k)]);
      }
    }
  };
  for_others([](size_t place, Index, Group& group) { group.place.push_back(static_cast<Index>(place)); });
  for (Group& group : groups) group.coefficient.resize(static_cast<Index>(group.place.size()), tensor.rank());
  std::vector<Index> filled(groups.size(), 0);
  for_others([&](size_t place, Index k, Group& group) {
    Index& row = filled[static_cast<size_t>(&group - groups.data())];
    group.coefficient.row(row++) = tensor.coefficient.row(which[place]).segment(k * tensor.rank(), tensor.rank());
  });
  return groups;
}

/// Subtracts the part of one cluster from columns [begin, begin + count) of the residuals.
void subtract(const Group& group, const RowMatrix& basis, Index begin, Index count, RowMatrix& product,
              DenseTensor& rests) {
  const auto rows = static_cast<Index>(group.place.size());
  product.resize(rows, count);
  multiply({group.coefficient.data(), rows, basis.rows(), basis.rows(), 1},
           {basis.data() + begin, basis.rows(), count, basis.cols(), 1}, {product.data(), rows, count, count, 1});
  for (Index i = 0; i < rows; ++i) {
    float* const row = rests.data.data() + group.place[static_cast<size_t>(i)] * rests.extent[1] + begin;
    Eigen::Map<Eigen::RowVectorXf>(row, count) -= product.row(i);
  }
}

}  // namespace

DenseTensor cluster_rests(const TensorView& slices, const ClusteredTensor& tensor, const std::vector<RowMatrix>& basis,
                          std::span<const Index> which, uint32_t but, const TensorOptions& options,
                          const Progress& progress) {
  const Index entries = slices.size() / std::max<Index>(slices.extent(0), 1);
  const std::vector<Group> groups = grouped(tensor, which, but);
  DenseTensor rests({static_cast<Index>(which.size()), entries});
  parallel_pieces(
      static_cast<size_t>((entries + kRestColumns - 1) / kRestColumns), options.threads, progress, [&](size_t piece) {
        const Index begin = static_cast<Index>(piece) * kRestColumns, count = std::min(kRestColumns, entries - begin);
        for (size_t i = 0; i < which.size(); ++i) {
          std::copy_n(slices.data() + which[i] * entries + begin, count,
                      rests.data.begin() + static_cast<Index>(i) * entries + begin);
        }
        RowMatrix product;
        for (size_t c = 0; c < groups.size(); ++c) {
          if (!groups[c].place.empty()) subtract(groups[c], basis[c], begin, count, product, rests);
        }
      });
  return rests;
}

namespace {

constexpr int kSteps = 20;

/// Samples each center in proportion to the squared distance to the nearest previous one.
RowMatrix seeds(const RowMatrix& points, Index count, uint64_t seed) {
  RowMatrix center(count, points.cols());
  std::vector<double> distance(static_cast<size_t>(points.rows()), std::numeric_limits<double>::infinity());
  RandomStream random(seed, 0, 0);
  Index next = std::min(points.rows() - 1, static_cast<Index>(random.next() * static_cast<float>(points.rows())));
  for (Index c = 0; c < count; ++c) {
    center.row(c) = points.row(next);
    double sum = 0;
    for (Index i = 0; i < points.rows(); ++i) {
      double& d = distance[static_cast<size_t>(i)];
      sum += d = std::min(d, static_cast<double>((points.row(i) - center.row(c)).squaredNorm()));
    }
    double rest = static_cast<double>(random.next()) * sum;
    for (next = 0; next + 1 < points.rows(); ++next) {
      rest -= distance[static_cast<size_t>(next)];
      if (rest < 0) break;
    }
  }
  return center;
}

uint32_t nearest(const RowMatrix& center, const Eigen::RowVectorXf& point) {
  Index best = 0;
  (center.rowwise() - point).rowwise().squaredNorm().minCoeff(&best);
  return static_cast<uint32_t>(best);
}

}  // namespace

RowMatrix slice_coordinates(const TensorView& slices, Index rank, const TensorOptions& options,
                            const Progress& progress) {
  const RowMatrix space = leading_vectors(slices, 1, rank, options, progress);
  const DenseTensor product = mode_product(slices, 1, space.transpose(), options.threads, progress);
  return Eigen::Map<const RowMatrix>(product.data.data(), product.extent[0], product.extent[1]);
}

std::vector<uint32_t> clusters_by_direction(RowMatrix points, Index clusters, uint64_t seed) {
  points.rowwise().normalize();  // zero stays zero
  RowMatrix center = seeds(points, clusters, seed);
  std::vector<uint32_t> member(static_cast<size_t>(points.rows()));
  for (int step = 0; step < kSteps; ++step) {
    RowMatrix sum = RowMatrix::Zero(center.rows(), center.cols());
    for (Index i = 0; i < points.rows(); ++i) {
      const uint32_t c = member[static_cast<size_t>(i)] = nearest(center, points.row(i));
      sum.row(c) += points.row(i);
    }
    for (Index c = 0; c < sum.rows(); ++c) sum.row(c).normalize();
    if (sum == center) break;
    center = sum;
  }
  return member;
}

}  // namespace velour
