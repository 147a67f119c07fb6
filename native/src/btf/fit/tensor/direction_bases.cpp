#include "btf/fit/tensor/direction_bases.h"

#include <algorithm>
#include <numeric>
#include "base/parallel.h"
#include "btf/fit/shown_views.h"
#include "btf/fit/surface_points.h"
#include "btf/model/srbf_btf.h"
#include "math/sphere/random.h"
#include "math/tensor/decompositions.h"
#include "math/tensor/mode_product.h"

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

}  // namespace velour
