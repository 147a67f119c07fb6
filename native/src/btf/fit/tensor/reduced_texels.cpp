#include "btf/fit/tensor/reduced_texels.h"

#include <Eigen/Cholesky>

#include "base/parallel.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/surface_points.h"
#include "btf/model/srbf_btf.h"

namespace velour {
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
