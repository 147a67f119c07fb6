#include "compress/tensor_functions.h"

#include "job/parallel.h"

namespace velour {
namespace {

std::vector<HalfBits> halves_of(const RowMatrix& matrix) {
  std::vector<HalfBits> halves(static_cast<size_t>(matrix.size()));
  floats_to_halves({matrix.data(), halves.size()}, halves);
  return halves;
}

RowMatrix matrix_of(const std::vector<HalfBits>& halves, Index columns) {
  RowMatrix matrix(static_cast<Index>(halves.size()) / columns, columns);
  halves_to_floats(halves, {matrix.data(), halves.size()});
  return matrix;
}

}  // namespace

std::vector<TensorBtfCluster> stored_clusters(const ClusteredTensor& tensor, const DirectionBases& bases) {
  std::vector<TensorBtfCluster> stored;
  for (const TensorCluster& cluster : tensor.cluster) {
    store({bases.view.vector * cluster.factor[0], bases.light.vector * cluster.factor[1], cluster.factor[2],
           cluster.core},
          stored.emplace_back());
  }
  return stored;
}

std::vector<DirectionCluster> direction_clusters(const TensorSide& side) {
  std::vector<DirectionCluster> clusters;
  for (const TensorBtfCluster& c : side.clusters) {
    clusters.push_back({matrix_of(c.view, side.rank.view), matrix_of(c.light, side.rank.light),
                        matrix_of(c.color, side.rank.color),
                        matrix_of(c.core, Index{side.rank.light} * side.rank.color)});
  }
  return clusters;
}

void store(const DirectionCluster& cluster, TensorBtfCluster& to) {
  to.view = halves_of(cluster.view);
  to.light = halves_of(cluster.light);
  to.color = halves_of(cluster.color);
  to.core = halves_of(cluster.core);
}

FunctionsOfView functions_of_view(const std::vector<DirectionCluster>& clusters, Index view) {
  const Index rank = clusters[0].rank(), count = static_cast<Index>(clusters.size()) * rank;
  FunctionsOfView functions;
  for (RowMatrix& f : functions) f.resize(count, clusters[0].light.rows());
  for (size_t c = 0; c < clusters.size(); ++c) {
    const DirectionCluster& cluster = clusters[c];
    const Index views = cluster.view.cols(), lights = cluster.light.cols(), colors = cluster.color.cols();
    for (Index r = 0; r < rank; ++r) {
      const Eigen::RowVectorXf mixed = cluster.view.row(view) * cluster.core.middleRows(r * views, views);
      const Eigen::Map<const RowMatrix> core(mixed.data(), lights, colors);
      const RowMatrix values = cluster.color * (cluster.light * core).transpose();
      for (size_t a = 0; a < 3; ++a)
        functions[a].row(static_cast<Index>(c) * rank + r) = values.row(static_cast<Index>(a));
    }
  }
  return functions;
}

TensorFunctions::TensorFunctions(const TensorSide& side, int threads, const Progress& progress)
    : cluster_(direction_clusters(side)), rank_(static_cast<Index>(side.rank.texel)) {
  const auto views = static_cast<size_t>(cluster_.at(0).view.rows());
  products_.resize(views);
  parallel_pieces(views, threads, progress, [&](size_t v) {
    const auto view = static_cast<Index>(v);
    products_[v] = weighed_products(view, Eigen::VectorXf::Ones(cluster_[0].light.rows()));
  });
  all_ = RowMatrix::Zero(count(), count());
  for (const RowMatrix& product : products_) all_ += product;
}

RowMatrix TensorFunctions::weighed_products(Index view, const Eigen::VectorXf& weight) const {
  RowMatrix products = RowMatrix::Zero(count(), count());
  for (const RowMatrix& f : of_view(view)) products.noalias() += f * weight.asDiagonal() * f.transpose();
  return products;
}

Eigen::MatrixXf TensorFunctions::of_members(const RowMatrix& products, Index rank, const std::vector<uint32_t>& members,
                                            float ridge) {
  const auto count = static_cast<Index>(members.size());
  Eigen::MatrixXf matrix(count * rank, count * rank);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) {
      matrix.block(i * rank, j * rank, rank, rank) =
          products.block(members[static_cast<size_t>(i)] * rank, members[static_cast<size_t>(j)] * rank, rank, rank);
    }
  }
  matrix.diagonal().array() += ridge;
  return matrix;
}

}  // namespace velour
