#include "btf/fit/seen_texels.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"

namespace velour {

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
