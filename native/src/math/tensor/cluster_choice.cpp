#include "math/tensor/cluster_choice.h"

#include <algorithm>
#include <Eigen/Cholesky>
#include <numeric>

#include "base/parallel.h"
#include "math/tensor/tensor_view.h"

namespace velour {

RowMatrix TensorCluster::basis(const TensorOptions& options, const Progress& progress) const {
  std::vector<Index> extents{core.rows()};
  for (const RowMatrix& f : factor) extents.push_back(f.cols());
  DenseTensor tensor(extents);
  std::copy_n(core.data(), core.size(), tensor.data.begin());
  for (size_t mode = 0; mode < factor.size(); ++mode) {
    tensor = mode_product(tensor.view(), mode + 1, factor[mode], options.threads, progress);
  }
  return Eigen::Map<const RowMatrix>(tensor.data.data(), core.rows(),
                                     static_cast<Index>(tensor.data.size()) / core.rows());
}

Index ClusteredTensor::size() const {
  Index size = 1;
  for (size_t mode = 1; mode < extent.size(); ++mode) size *= extent[mode];
  return size;
}

Index ClusteredTensor::parameters() const {
  Index sum = coefficient.size();
  for (const TensorCluster& c : cluster) {
    sum += c.core.size();
    for (const RowMatrix& f : c.factor) sum += f.size();
  }
  return sum;
}

DenseTensor expanded(const ClusteredTensor& tensor, const TensorOptions& options, const Progress& progress) {
  DenseTensor slices(tensor.extent);
  std::vector<RowMatrix> basis;
  for (const TensorCluster& c : tensor.cluster) basis.push_back(c.basis(options, progress));
  for (Index i = 0; i < tensor.slices(); ++i) {
    Eigen::Map<Eigen::RowVectorXf> slice(slices.data.data() + i * tensor.size(), tensor.size());
    for (Index k = 0; k < tensor.members; ++k) {
      const auto part = tensor.coefficient.row(i).segment(k * tensor.rank(), tensor.rank());
      slice += part * basis[tensor.member[static_cast<size_t>(i * tensor.members + k)]];
    }
  }
  return slices;
}

namespace {

constexpr float kRidge = 1e-6f;  // added to a unit diagonal, because the bases of clusters may overlap
constexpr Index kSlices = 64;    // per piece of work

RowMatrix stacked(const std::vector<RowMatrix>& basis) {
  const Index rank = basis.at(0).rows();
  RowMatrix all(rank * static_cast<Index>(basis.size()), basis[0].cols());
  for (size_t c = 0; c < basis.size(); ++c) all.middleRows(static_cast<Index>(c) * rank, rank) = basis[c];
  return all;
}

RowMatrix as_matrix(const DenseTensor& tensor) {
  return Eigen::Map<const RowMatrix>(tensor.data.data(), tensor.extent[0], tensor.extent[1]);
}

/// Chooses the members of one slice, which keeps better previous ones if it `had` any; adds to `kept`.
void choose(const ClusterProducts& products, Index slice, bool had, ClusteredTensor& tensor, KeptSquares& kept) {
  const std::span<uint32_t> member(tensor.member.data() + slice * tensor.members, static_cast<size_t>(tensor.members));
  auto row = tensor.coefficient.row(slice);
  std::vector<uint32_t> chosen;
  Eigen::RowVectorXf coefficient;
  double most = 0;
  while (chosen.size() < member.size()) {
    products.extend(slice, chosen, coefficient);
    coefficient.resize(static_cast<Index>(chosen.size()) * products.rank());
    most = products.solve(slice, chosen, coefficient);
  }
  const double before = had ? products.solve(slice, member, row) : 0;
  kept.before += before;
  kept.after += std::max(before, most);
  if (had && before >= most) return;
  std::copy(chosen.begin(), chosen.end(), member.begin());
  row = coefficient;
}

}  // namespace

ClusterProducts::ClusterProducts(const TensorView& slices, const std::vector<RowMatrix>& basis,
                                 const TensorOptions& options, const Progress& progress)
    : rank_(basis.at(0).rows()) {
  const RowMatrix all = stacked(basis);
  projection_ = as_matrix(mode_product(slices, 1, all, options.threads, progress));
  const TensorView rows(all.data(), {all.rows(), all.cols()});
  products_ = as_matrix(mode_product(rows, 1, all, options.threads, progress));
}

double ClusterProducts::kept(Index slice, Index cluster) const {
  return static_cast<double>(projection_.row(slice).segment(cluster * rank_, rank_).squaredNorm());
}

double ClusterProducts::solve(Index slice, std::span<const uint32_t> clusters,
                              Eigen::Ref<Eigen::RowVectorXf> coefficient) const {
  const auto count = static_cast<Index>(clusters.size());
  Eigen::VectorXf right(count * rank_);
  Eigen::MatrixXf matrix(count * rank_, count * rank_);
  for (Index i = 0; i < count; ++i) {
    const Index from = static_cast<Index>(clusters[static_cast<size_t>(i)]) * rank_;
    right.segment(i * rank_, rank_) = projection_.row(slice).segment(from, rank_).transpose();
    for (Index j = 0; j < count; ++j) {
      matrix.block(i * rank_, j * rank_, rank_, rank_) =
          products_.block(from, static_cast<Index>(clusters[static_cast<size_t>(j)]) * rank_, rank_, rank_);
    }
  }
  if (count == 1) {
    coefficient = right.transpose();
    return static_cast<double>(right.squaredNorm());
  }
  Eigen::MatrixXf ridged = matrix;
  ridged.diagonal().array() += kRidge;
  const Eigen::VectorXf solution = ridged.llt().solve(right);
  coefficient = solution.transpose();
  return static_cast<double>(2 * solution.dot(right) - solution.dot(matrix * solution));
}

void ClusterProducts::extend(Index slice, std::vector<uint32_t>& clusters,
                             const Eigen::RowVectorXf& coefficient) const {
  Eigen::RowVectorXf rest = projection_.row(slice);
  for (size_t k = 0; k < clusters.size(); ++k) {
    rest -= coefficient.segment(static_cast<Index>(k) * rank_, rank_) *
            products_.middleRows(static_cast<Index>(clusters[k]) * rank_, rank_);
  }
  uint32_t best = 0;
  float most = -1;
  for (uint32_t c = 0; c < static_cast<uint32_t>(this->clusters()); ++c) {
    if (std::find(clusters.begin(), clusters.end(), c) != clusters.end()) continue;
    const float gain = rest.segment(static_cast<Index>(c) * rank_, rank_).squaredNorm();
    if (gain <= most) continue;
    most = gain;
    best = c;
  }
  clusters.insert(std::upper_bound(clusters.begin(), clusters.end(), best), best);
}

KeptSquares choose_members(const ClusterProducts& products, ClusteredTensor& tensor, const TensorOptions& options,
                           const Progress& progress) {
  const Index slices = products.slices(), columns = tensor.members * products.rank();
  const bool had = tensor.coefficient.rows() == slices && tensor.coefficient.cols() == columns;
  if (!had) {
    tensor.member.assign(static_cast<size_t>(slices * tensor.members), 0);
    tensor.coefficient = RowMatrix::Zero(slices, columns);
  }
  std::vector<KeptSquares> kept(static_cast<size_t>((slices + kSlices - 1) / kSlices), KeptSquares{0, 0});
  parallel_pieces(kept.size(), options.threads, progress, [&](size_t piece) {
    const Index end = std::min(slices, static_cast<Index>(piece + 1) * kSlices);
    for (Index i = static_cast<Index>(piece) * kSlices; i < end; ++i) choose(products, i, had, tensor, kept[piece]);
  });
  const auto sum = [](const KeptSquares& a, const KeptSquares& b) {
    return KeptSquares{a.before + b.before, a.after + b.after};
  };
  return std::accumulate(kept.begin(), kept.end(), KeptSquares{0, 0}, sum);
}

}  // namespace velour
