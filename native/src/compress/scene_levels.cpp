#include "compress/scene_levels.h"

#include <algorithm>

namespace velour {
namespace {

const std::vector<TexelLevel>& levels_of(const FactoredBtf& btf) { return btf.levels; }
/// All sides have levels of the same sizes.
template <typename Btf>
const auto& levels_of(const Btf& btf) {
  return btf.sides.at(0).levels;
}

template <typename Levels>
void leave_out_of(Levels& levels, size_t count) {
  levels.erase(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(count));
}
void leave_out(FactoredBtf& btf, size_t count) { leave_out_of(btf.levels, count); }
template <typename Btf>
void leave_out(Btf& btf, size_t count) {
  for (auto& side : btf.sides) leave_out_of(side.levels, count);
}

/// Whether a tile keeps its shape with the texels of `level`.
bool keeps_shape(const TexelGrid& grid, const auto& level) {
  return grid.tile_metres || uint64_t{level.width} * grid.height == uint64_t{level.height} * grid.width;
}

bool shows_nothing(const FactoredBtf&) { return false; }
template <typename Btf>
bool shows_nothing(const Btf& btf) {
  return btf.sides.empty();
}

}  // namespace

size_t unresolved_levels(const ModelBody& body, const SurfaceDomain& seen) {
  return with_btf(body, [&](const auto& btf) {
    if (shows_nothing(btf)) return size_t{0};
    const auto& levels = levels_of(btf);
    size_t count = 0;
    while (count + 1 < levels.size()) {
      const auto& next = levels[count + 1];
      if (!resolves(std::max(next.width, next.height), finest_footprint(seen)) || !keeps_shape(btf.grid, next)) break;
      ++count;
    }
    return count;
  });
}

ModelBody without_finest(const ModelBody& body, size_t count) {
  if (count == 0) return body;
  return with_btf(body, [count](auto btf) -> ModelBody {
    leave_out(btf, count);
    btf.grid.width = levels_of(btf).front().width;
    btf.grid.height = levels_of(btf).front().height;
    return btf;
  });
}

}  // namespace velour
