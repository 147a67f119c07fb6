#include "btf/fit/seen_texels.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "btf/fit/relief_pyramid.h"
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

SeenTexels::SeenTexels(const TensorSource& source, size_t level, const Progress& progress)
    : relief_(source.relief[level]), plane_(is_plane(relief_)) {
  if (plane_) return;
  seen_.resize(source.side.view.size() * texels());
  parallel_pieces(source.side.view.size(), source.threads, progress, [&](size_t v) {
    for (size_t t = 0; t < texels(); ++t) {
      const Vec2 place =
          (Vec2(t % relief_.width(), t / relief_.width()) + 0.5f) / Vec2(relief_.width(), relief_.height());
      seen_[v * texels() + t] = relief_.seen_texel(place, source.side.view[v]);
    }
  });
}

BilinearTexels SeenTexels::at(Index view, size_t texel) const {
  const auto own = static_cast<uint32_t>(texel);
  if (plane_) return {{own, own, own, own}, {1, 0, 0, 0}};
  return bilinear_at(seen_[static_cast<size_t>(view) * texels() + texel], relief_.width(), relief_.height());
}

SeenTexels::Sources SeenTexels::sources(Index view) const {
  Sources sources;
  sources.first.resize(texels() + 1);
  std::vector<BilinearTexels> seen;
  for (size_t t = 0; t < texels(); ++t) {
    seen.push_back(at(view, t));
    for (const uint32_t i : seen.back().index) ++sources.first[i + 1];
  }
  std::partial_sum(sources.first.begin(), sources.first.end(), sources.first.begin());
  sources.source.resize(4 * texels());
  sources.weight.resize(4 * texels());
  std::vector<uint32_t> next = sources.first;
  for (uint32_t t = 0; t < seen.size(); ++t) {
    for (size_t i = 0; i < 4; ++i) {
      const uint32_t to = next[seen[t].index[i]]++;
      sources.source[to] = t;
      sources.weight[to] = seen[t].weight[i];
    }
  }
  return sources;
}

RowMatrix SeenTexels::spread(Index view, size_t first, size_t end, const TensorTexelValues& values,
                             Index functions) const {
  const Index members = values.members(), rank = values.rank();
  RowMatrix spread = RowMatrix::Zero(static_cast<Index>(end - first), functions);
  for (size_t t = first; t < end; ++t) {
    const BilinearTexels seen = at(view, t);
    for (size_t i = 0; i < 4; ++i) {
      if (seen.weight[i] == 0) continue;
      const auto from = static_cast<Index>(seen.index[i]);
      for (Index k = 0; k < members; ++k) {
        const Index cluster = values.member[static_cast<size_t>(from * members + k)];
        spread.row(static_cast<Index>(t - first)).segment(cluster * rank, rank) +=
            seen.weight[i] * values.value.row(from).segment(k * rank, rank);
      }
    }
  }
  return spread;
}

}  // namespace velour
