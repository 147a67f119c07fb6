#include "btf/fit/tensor/direction_bases.h"

#include <algorithm>
#include <Eigen/Cholesky>
#include <numeric>

#include "base/parallel.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/seen_texels.h"
#include "btf/model/srbf_btf.h"
#include "math/sphere/random.h"
#include "math/tensor/decompositions.h"
#include "math/tensor/tensor_view.h"

namespace velour {

namespace {

constexpr double kNegligible = 1e-10;  // relative to the strongest energy; less is rounding error

/// The strongest eigenvectors of mean products.
DirectionBasis basis_of(const Eigen::MatrixXd& products, Index rank) {
  const Eigenpairs pairs = eigenpairs(products);
  const Eigen::VectorXd energy = pairs.value.cwiseMax(0.0);
  Index count = 1;
  while (count < std::min(rank, energy.size()) && energy[count] > kNegligible * energy[0]) ++count;
  DirectionBasis basis;
  basis.vector = pairs.vector.leftCols(count).cast<float>();
  basis.energy = energy.head(count);
  basis.rest = energy.tail(energy.size() - count).sum() / static_cast<double>(energy.size());
  return basis;
}

/// Gives points hidden from a view their values in the nearest view that shows them.
void fill_hidden(const std::vector<Vec3>& views, const RowMatrix& shown, DenseTensor& values) {
  const auto order = nearest_first(views);
  const Index of_views = shown.cols(), row = static_cast<Index>(values.data.size()) / shown.size();
  for (Index i = 0; i < shown.rows(); ++i) {
    for (Index v = 0; v < of_views; ++v) {
      if (shown(i, v) > 0) continue;
      const auto& near = order[static_cast<size_t>(v)];
      const auto from = std::find_if(near.begin(), near.end(), [&](Index other) { return shown(i, other) > 0; });
      if (from == near.end()) continue;
      std::copy_n(values.data.begin() + (i * of_views + *from) * row, row,
                  values.data.begin() + (i * of_views + v) * row);
    }
  }
}

/// Values of points: [point][view][light][axis].
DenseTensor values_of_points(CompandedViews& views, const TensorSource& source, const std::vector<uint32_t>& texels,
                             Progress& progress) {
  const auto count = static_cast<Index>(texels.size()), lights = static_cast<Index>(source.side.light.size()),
             of_views = static_cast<Index>(source.side.view.size());
  DenseTensor values({count, of_views, lights, 3});
  RowMatrix shows = RowMatrix::Zero(count, of_views);
  std::vector<LevelImages> images;
  for (Index v = 0; v < of_views; ++v) {
    progress.check();
    read_side_view(views, source.grid, source.side, static_cast<size_t>(v), 1, images);
    const auto shown = shown_texels(source.relief[0], texels, source.side.view[static_cast<size_t>(v)],
                                    tile_aspect(source.grid), source.threads, progress);
    for (Index i = 0; i < count; ++i) {
      if (!shown[static_cast<size_t>(i)].shown) continue;
      shows(i, v) = 1;
      Eigen::Map<RowMatrix> target(values.data.data() + (i * of_views + v) * lights * 3, lights, 3);
      for (Index a = 0; a < 3; ++a) {
        target.col(a) = blended(images[0].value[static_cast<size_t>(a)], shown[static_cast<size_t>(i)].at).transpose();
      }
    }
    progress.update(static_cast<double>(v + 1) / static_cast<double>(of_views));
  }
  fill_hidden(source.side.view, shows, values);
  return values;
}

}  // namespace

std::vector<uint32_t> random_texels(uint64_t texels, size_t count, uint64_t seed) {
  std::vector<uint32_t> all(texels);
  std::iota(all.begin(), all.end(), 0u);
  const auto key = [&](uint32_t t) { return std::pair(mix64(mix64(seed + 1) + t), t); };
  std::sort(all.begin(), all.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  all.resize(std::min<uint64_t>(count, texels));
  return all;
}

DirectionBases direction_bases(CompandedViews& views, const TensorSource& source, Index rank, size_t points,
                               Progress& progress) {
  const std::vector<uint32_t> texels = random_texels(source.grid.texels(), points, source.seed);
  const DenseTensor values = values_of_points(views, source, texels, progress);
  const auto count = static_cast<double>(texels.size());
  return {basis_of(slice_products(values.view(), 1, source.threads, progress) / count, rank),
          basis_of(slice_products(values.view(), 2, source.threads, progress) / count, rank)};
}

namespace {

ShownTexel shown_texel(const Relief& relief, uint32_t texel, const Vec3& wv, float aspect) {
  if (is_plane(relief)) return {{{texel, texel, texel, texel}, {1, 0, 0, 0}}, true};
  const uint32_t x = texel % relief.width(), y = texel / relief.width();
  const Vec2 place = (Vec2(x, y) + 0.5f) / Vec2(relief.width(), relief.height());
  const std::optional<Vec2> at = shown_at(relief, place, relief.height_of(x, y), aspect, wv);
  return {bilinear_texels(at.value_or(place), relief.width(), relief.height()), at.has_value()};
}

}  // namespace

std::vector<ShownTexel> shown_texels(const Relief& relief, const std::vector<uint32_t>& texels, const Vec3& wv,
                                     float aspect, int threads, const Progress& progress) {
  std::vector<ShownTexel> shown(texels.size());
  parallel_pieces((texels.size() + kTexelsPerPiece - 1) / kTexelsPerPiece, threads, progress, [&](size_t piece) {
    const size_t end = std::min(texels.size(), (piece + 1) * kTexelsPerPiece);
    for (size_t i = piece * kTexelsPerPiece; i < end; ++i) shown[i] = shown_texel(relief, texels[i], wv, aspect);
  });
  return shown;
}

namespace {

constexpr Index kViews = 9;  // added at once
constexpr size_t kGapPixels = 1000;
constexpr double kMinNoise = 1e-3;  // relative to the mean energy of a view

class Reduction {
 public:
  Reduction(const TensorSource& source, const DirectionBases& bases, std::vector<uint32_t> texels,
            const Progress& progress)
      : source_(source),
        bases_(bases),
        progress_(progress),
        reduced_{
            {},
            DenseTensor({static_cast<Index>(texels.size()), bases.view.vector.cols(), bases.light.vector.cols(), 3}),
            0},
        row_(3 * bases.light.vector.cols()),
        gap_(source, kGapPixels, progress),
        shown_(RowMatrix::Zero(static_cast<Index>(texels.size()), bases.view.vector.rows())) {
    reduced_.texel = std::move(texels);
  }

  void add_view(Index view, const LevelImages& images) {
    if (held_ == 0) waiting_.setZero(static_cast<Index>(reduced_.texel.size()), kViews * row_);
    const auto shown = shown_texels(source_.relief[0], reduced_.texel, source_.side.view[static_cast<size_t>(view)],
                                    tile_aspect(source_.grid), source_.threads, progress_);
    std::array<RowMatrix, 3> projected;
    for (size_t a = 0; a < 3; ++a) projected[a] = images.value[a] * bases_.light.vector;
    pieces([&](Index i) {
      const ShownTexel& from = shown[static_cast<size_t>(i)];
      if (!from.shown) return;
      shown_(i, view) = 1;
      Eigen::Map<RowMatrix> target(waiting_.row(i).data() + held_ * row_, row_ / 3, 3);
      for (Index a = 0; a < 3; ++a) target.col(a) = blended(projected[static_cast<size_t>(a)], from.at).transpose();
    });
    if (++held_ == kViews) add_held(view);
    gap_.add_view(view, images);
  }

  ReducedTexels take() {
    if (held_ > 0) add_held(bases_.view.vector.rows() - 1);
    pieces([&](Index i) { fill(i); });
    reduced_.relief_share = gap_.share();
    return std::move(reduced_);
  }

 private:
  template <class Work>
  void pieces(const Work& work) const {
    const size_t count = reduced_.texel.size();
    parallel_pieces((count + kTexelsPerPiece - 1) / kTexelsPerPiece, source_.threads, progress_, [&](size_t piece) {
      const size_t end = std::min(count, (piece + 1) * kTexelsPerPiece);
      for (size_t i = piece * kTexelsPerPiece; i < end; ++i) work(static_cast<Index>(i));
    });
  }

  Eigen::Map<RowMatrix> slice(Index i) {
    const Index rank = bases_.view.vector.cols();
    return {reduced_.slices.data.data() + i * rank * row_, rank, row_};
  }

  /// Adds the buffered views; `last` is the last of them.
  void add_held(Index last) {
    const RowMatrix turn = bases_.view.vector.middleRows(last + 1 - held_, held_).transpose();
    pieces([&](Index i) {
      slice(i).noalias() += turn * Eigen::Map<const RowMatrix>(waiting_.row(i).data(), held_, row_);
    });
    held_ = 0;
  }

  /// Solves for a texel that is hidden from some views.
  void fill(Index i) {
    if (shown_.row(i).minCoeff() > 0) return;
    const DirectionBasis& view = bases_.view;
    const double mean = view.rest + view.energy.sum() / static_cast<double>(view.vector.rows());
    const double noise = std::max(view.rest, kMinNoise * mean);
    const RowMatrix seen = shown_.row(i).transpose().asDiagonal() * view.vector;
    Eigen::MatrixXd matrix = (seen.transpose() * seen).cast<double>();
    for (Index k = 0; k < matrix.rows(); ++k)
      matrix(k, k) += noise > 0 ? noise / std::max(view.energy[k], 1e-12 * mean) : 1.0;
    const Eigen::MatrixXd solution = matrix.llt().solve(slice(i).cast<double>());
    slice(i) = solution.cast<float>();
  }

  const TensorSource& source_;
  const DirectionBases& bases_;
  const Progress& progress_;
  ReducedTexels reduced_;
  Index row_;  // entries of a view: [light basis][axis]
  ReliefGap gap_;
  RowMatrix shown_;    // texel x view: 1 or 0
  RowMatrix waiting_;  // buffered views: texel x [view][entry]
  Index held_ = 0;     // number of buffered views
};

}  // namespace

ReducedTexels reduced_texels(CompandedViews& views, const TensorSource& source, const DirectionBases& bases,
                             std::vector<uint32_t> texels, Progress& progress) {
  Reduction reduction(source, bases, std::move(texels), progress);
  std::vector<LevelImages> images;
  for (size_t v = 0; v < source.side.view.size(); ++v) {
    progress.check();
    read_side_view(views, source.grid, source.side, v, 1, images);
    reduction.add_view(static_cast<Index>(v), images[0]);
    progress.update(static_cast<double>(v + 1) / static_cast<double>(source.side.view.size()));
  }
  return reduction.take();
}

}  // namespace velour
