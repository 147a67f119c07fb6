#include "btf/fit/tensor/tensor_functions.h"

#include <algorithm>
#include <numeric>
#include "base/parallel.h"
#include "btf/fit/relief_pyramid.h"

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

MemberSets::MemberSets(const TensorTexelValues& values) : values_(values) {
  texels_.resize(static_cast<size_t>(values.value.rows()));
  std::iota(texels_.begin(), texels_.end(), 0u);
  std::stable_sort(texels_.begin(), texels_.end(),
                   [&](uint32_t a, uint32_t b) { return std::ranges::lexicographical_compare(of(a), of(b)); });
  for (size_t i = 0; i < texels_.size(); ++i) {
    if (i == 0 || !std::ranges::equal(of(texels_[i]), of(texels_[i - 1]))) first_.push_back(i);
  }
  first_.push_back(texels_.size());
}

namespace {

constexpr size_t kFunctions = 16;  // per piece of work; fixed, because sums depend on it

size_t pieces(size_t count, size_t of_piece) { return (count + of_piece - 1) / of_piece; }

}  // namespace

ViewMoments::ViewMoments(Index functions, Index lights) : products(RowMatrix::Zero(functions, functions)) {
  for (RowMatrix& image : images) image = RowMatrix::Zero(functions, lights);
}

void add_level(const SeenTexels& seen, Index view, const LevelImages& images, const TensorTexelValues& values,
               float brightness, int threads, const Progress& progress, ViewMoments& moments) {
  const Index functions = moments.products.rows();
  RowMatrix spread(static_cast<Index>(seen.texels()), functions);
  parallel_pieces(pieces(seen.texels(), kTexelsPerPiece), threads, progress, [&](size_t piece) {
    const size_t first = piece * kTexelsPerPiece, end = std::min(seen.texels(), first + kTexelsPerPiece);
    spread.middleRows(static_cast<Index>(first), static_cast<Index>(end - first)) =
        seen.spread(view, first, end, values, functions);
  });
  parallel_pieces(pieces(static_cast<size_t>(functions), kFunctions), threads, progress, [&](size_t piece) {
    const auto first = static_cast<Index>(piece * kFunctions), count = std::min<Index>(kFunctions, functions - first);
    const auto some = spread.middleCols(first, count).transpose();
    moments.products.middleRows(first, count).noalias() += some * spread;
    for (size_t a = 0; a < 3; ++a) {
      moments.images[a].middleRows(first, count).noalias() += brightness * (some * images.value[a]);
    }
  });
}

void add_hidden(const ShownViews& shown, Index view, const LevelImages& images, const TensorTexelValues& values,
                float brightness, int threads, const Progress& progress, std::vector<ViewMoments>& moments) {
  if (shown.all()) return;
  const ShownViews::Values of_view = shown.values(view, images, progress);
  const auto members = static_cast<size_t>(values.members());
  const Index rank = values.rank();
  parallel_pieces(moments.size(), threads, progress, [&](size_t v) {
    const auto hiding = static_cast<Index>(v);
    for (size_t t = 0; t < shown.texels(); ++t) {
      if (hiding == view || shown.stand_in(t, hiding) != view) continue;
      const auto row = static_cast<Index>(t);
      for (size_t k = 0; k < members; ++k) {
        const auto own = ShownViews::kHidden * values.value.row(row).segment(static_cast<Index>(k) * rank, rank);
        const Index first = values.member[t * members + k] * rank;
        for (size_t j = 0; j < members; ++j) {
          moments[v].products.block(first, values.member[t * members + j] * rank, rank, rank).noalias() +=
              own.transpose() * values.value.row(row).segment(static_cast<Index>(j) * rank, rank);
        }
        for (size_t a = 0; a < 3; ++a) {
          moments[v].images[a].middleRows(first, rank).noalias() += brightness * own.transpose() * of_view[a].row(row);
        }
      }
    }
  });
}

}  // namespace velour
