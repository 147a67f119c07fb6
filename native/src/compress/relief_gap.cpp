#include "compress/relief_gap.h"

#include "btf/srbf_btf.h"
#include "job/parallel.h"

namespace velour {

ReliefGap::ReliefGap(const TensorSource& source, size_t pixels, const Progress& progress)
    : source_(source), progress_(progress) {
  if (is_plane(source.relief[0])) return;
  pixel_ = random_texels(source.grid.texels(), pixels, source.seed);
  squares_.resize(pixel_.size());
}

void ReliefGap::add_view(Index view, const LevelImages& images) {
  const Relief& relief = source_.relief[0];
  const Vec3& wv = source_.side.view[static_cast<size_t>(view)];
  const Vec2 size(relief.width(), relief.height());
  parallel_pieces(pixel_.size(), source_.threads, progress_, [&](size_t i) {
    const Vec2 place = (Vec2(pixel_[i] % relief.width(), pixel_[i] / relief.width()) + 0.5f) / size;
    const BilinearTexels seen = bilinear_at(relief.seen_texel(place, wv), relief.width(), relief.height());
    const std::vector<uint32_t> texels(seen.index.begin(), seen.index.end());
    const auto shown = shown_texels(relief, texels, wv, tile_aspect(source_.grid), 1, progress_);
    float weight = 0;
    for (size_t k = 0; k < 4; ++k) weight += shown[k].shown ? seen.weight[k] : 0.0f;
    if (weight == 0) return;  // other views show what is there
    for (const RowMatrix& image : images.value) {
      Eigen::RowVectorXf rest = image.row(pixel_[i]);
      squares_[i].image += static_cast<double>(rest.squaredNorm());
      for (size_t k = 0; k < 4; ++k) {
        if (shown[k].shown) rest -= seen.weight[k] / weight * blended(image, shown[k].at);
      }
      squares_[i].difference += static_cast<double>(rest.squaredNorm());
    }
  });
}

double ReliefGap::share() const {
  Squares sum;
  for (const Squares& s : squares_) {
    sum.difference += s.difference;
    sum.image += s.image;
  }
  return sum.image > 0 ? sum.difference / sum.image : 0.0;
}

}  // namespace velour
