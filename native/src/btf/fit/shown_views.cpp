#include "btf/fit/shown_views.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "btf/fit/surface_points.h"
#include "btf/model/srbf_btf.h"

namespace velour {
namespace {

std::vector<uint32_t> numbers(size_t count) {
  std::vector<uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace

std::vector<std::vector<Index>> nearest_first(const std::vector<Vec3>& directions) {
  std::vector<std::vector<Index>> order(directions.size());
  for (size_t v = 0; v < directions.size(); ++v) {
    order[v].resize(directions.size());
    std::iota(order[v].begin(), order[v].end(), Index{0});
    const auto nearness = [&](Index i) { return glm::dot(directions[v], directions[static_cast<size_t>(i)]); };
    std::stable_sort(order[v].begin(), order[v].end(), [&](Index a, Index b) { return nearness(a) > nearness(b); });
  }
  return order;
}

ShownViews::ShownViews(const TensorSource& source, size_t level, const Progress& progress)
    : source_(source),
      relief_(source.relief[level]),
      texels_(size_t{relief_.width()} * relief_.height()),
      stand_in_(texels_ * source.side.view.size(), -1) {
  const size_t count = source.side.view.size();
  const std::vector<uint32_t> all = numbers(texels_);
  for (size_t v = 0; v < count; ++v) {
    const auto shown =
        shown_texels(relief_, all, source.side.view[v], tile_aspect(source.grid), source.threads, progress);
    for (size_t t = 0; t < texels_; ++t) {
      if (shown[t].shown) stand_in_[t * count + v] = static_cast<int32_t>(v);
      all_ = all_ && shown[t].shown;
    }
  }
  if (all_) return;
  const auto order = nearest_first(source.side.view);
  for (size_t t = 0; t < texels_; ++t) {
    const std::vector<int32_t> of(stand_in_.begin() + static_cast<ptrdiff_t>(t * count),
                                  stand_in_.begin() + static_cast<ptrdiff_t>((t + 1) * count));
    for (size_t v = 0; v < count; ++v) {
      const auto from = std::find_if(order[v].begin(), order[v].end(),
                                     [&](Index other) { return of[static_cast<size_t>(other)] >= 0; });
      if (from != order[v].end()) stand_in_[t * count + v] = static_cast<int32_t>(*from);
    }
  }
}

ShownViews::Values ShownViews::values(Index view, const LevelImages& images, const Progress& progress) const {
  Values values;
  for (size_t a = 0; a < 3; ++a) values[a] = RowMatrix::Zero(images.value[a].rows(), images.value[a].cols());
  const auto shown = shown_texels(relief_, numbers(texels_), source_.side.view[static_cast<size_t>(view)],
                                  tile_aspect(source_.grid), source_.threads, progress);
  parallel_pieces((texels_ + kTexelsPerPiece - 1) / kTexelsPerPiece, source_.threads, progress, [&](size_t piece) {
    for (size_t t = piece * kTexelsPerPiece; t < std::min(texels_, (piece + 1) * kTexelsPerPiece); ++t) {
      if (!shown[t].shown) continue;
      for (size_t a = 0; a < 3; ++a) values[a].row(static_cast<Index>(t)) = blended(images.value[a], shown[t].at);
    }
  });
  return values;
}

}  // namespace velour
