#include "compress/scene_levels.h"

#include <algorithm>

namespace velour {
namespace {

/// Calls `use` with a BTF's body.
template <typename Use>
auto with_btf(const ModelBody& body, const Use& use) {
  if (const auto* factored = std::get_if<FactoredBtf>(&body)) return use(*factored);
  return use(std::get<SrbfBtf>(body));
}

const std::vector<TexelLevel>& levels_of(const FactoredBtf& btf) { return btf.levels; }
/// Those of all sides have the same sizes.
const std::vector<SrbfLevel>& levels_of(const SrbfBtf& btf) { return btf.sides.at(0).levels; }

template <typename Level>
void leave_out(std::vector<Level>& levels, size_t count) {
  levels.erase(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(count));
}
void leave_out(FactoredBtf& btf, size_t count) { leave_out(btf.levels, count); }
void leave_out(SrbfBtf& btf, size_t count) {
  for (SrbfSide& side : btf.sides) leave_out(side.levels, count);
}

/// Whether a tile keeps its shape with the texels of `level`.
bool keeps_shape(const TexelGrid& grid, const auto& level) {
  return grid.tile_metres || uint64_t{level.width} * grid.height == uint64_t{level.height} * grid.width;
}

bool shows_nothing(const ModelBody& body) {
  const auto* srbf = std::get_if<SrbfBtf>(&body);
  return srbf && srbf->sides.empty();
}

}  // namespace

size_t unresolved_levels(const ModelBody& body, const SurfaceDomain& seen) {
  if (shows_nothing(body)) return 0;
  return with_btf(body, [&](const auto& btf) {
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
