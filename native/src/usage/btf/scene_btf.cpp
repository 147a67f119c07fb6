#include "usage/btf/scene_btf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include "image/texels.h"

namespace velour {

namespace {

/// The largest angle, in radians, between a direction and its nearest neighbor on the same side.
double widest_gap(const std::vector<Vec3>& directions) {
  double widest = 0;
  for (const Vec3& a : directions) {
    float nearest = -1;
    for (const Vec3& b : directions) {
      if (a != b && a.z * b.z > 0) nearest = std::max(nearest, glm::dot(a, b));
    }
    widest = std::max(widest, std::acos(std::clamp(static_cast<double>(nearest), -1.0, 1.0)));
  }
  return widest;
}

std::vector<PolarAngles> chosen(const std::vector<PolarAngles>& set, const std::vector<uint32_t>& numbers) {
  std::vector<PolarAngles> angles;
  for (const uint32_t number : numbers) angles.push_back(set[number]);
  return angles;
}

bool any_below(const std::vector<PolarAngles>& set) {
  return std::ranges::any_of(set, [](const PolarAngles& angles) { return unit_direction(angles).z < 0; });
}

/// Index of the view nearest to the normal of a side.
size_t most_upright(const std::vector<Vec3>& directions, bool below) {
  size_t best = 0;
  for (size_t v = 1; v < directions.size(); ++v) {
    const float sign = below ? -1.0f : 1.0f;
    if (sign * directions[v].z > sign * directions[best].z) best = v;
  }
  return best;
}

class SceneBtf final : public BtfMeasurement {
 public:
  SceneBtf(const BtfMeasurement& fine, uint32_t halvings, SeenPairs pairs)
      : fine_(fine), halvings_(halvings), pairs_(std::move(pairs)) {
    layout_ = PairLayout(chosen(fine.layout().views(), pairs_.views), chosen(fine.layout().lights(), pairs_.lights));
    grid_ = fine.grid();
    shell_ = fine.shell();
    provenance_ = fine.provenance();
    for (uint32_t i = 0; i < halvings; ++i) {
      grid_.width = half_of(grid_.width);
      grid_.height = half_of(grid_.height);
    }
  }

  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    check_range(first, count);
    const size_t fine = fine_.grid().texels() * 3, coarse = grid_.texels() * 3;
    std::vector<HalfBits> halves(fine);
    std::vector<float> floats(fine);
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t pair = first + i;
      fine_.read_pairs(
          fine_.layout().first(pairs_.views[layout_->view_of(pair)]) + pairs_.lights[layout_->light_of(pair)], 1,
          halves);
      halves_to_floats(halves, floats);
      floats_to_halves(halved_image(floats, fine_.grid(), 3, halvings_), values.subspan(i * coarse, coarse));
    }
  }

  bool has_structure() const override { return fine_.has_structure(); }
  /// Heights are averaged over the covered area only; holes do not count.
  std::optional<ViewStructure> read_structure(uint32_t view) const override {
    auto structure = fine_.read_structure(pairs_.views[view]);
    if (structure) coarsen(*structure);
    return structure;
  }

 private:
  void coarsen(ViewStructure& s) const {
    for (size_t i = 0; i < s.coverage.size(); ++i) {
      s.height_spread[i] =
          s.coverage[i] * (s.height_spread[i] * s.height_spread[i] + s.height_mean[i] * s.height_mean[i]);
      s.height_mean[i] *= s.coverage[i];
    }
    for (auto* image : {&s.coverage, &s.height_mean, &s.height_spread}) {
      *image = halved_image(std::move(*image), fine_.grid(), 1, halvings_);
    }
    for (size_t i = 0; i < s.coverage.size(); ++i) {
      const float whole = s.coverage[i] > 0 ? 1 / s.coverage[i] : 0.0f;
      const float mean = s.height_mean[i] *= whole;
      s.height_spread[i] = std::sqrt(std::max(whole * s.height_spread[i] - mean * mean, 0.0f));
    }
  }

  const BtfMeasurement& fine_;
  const uint32_t halvings_;
  const SeenPairs pairs_;
};

}  // namespace

bool has_lower_side(const PairLayout& layout) { return any_below(layout.views()) && any_below(layout.lights()); }

SeenPairs pairs_around(const PairLayout& layout, const ViewWeights& seen) {
  std::vector<Vec3> directions;
  for (const PolarAngles& angles : layout.views()) directions.push_back(unit_direction(angles));
  const auto least = static_cast<float>(std::cos(std::min(kPiD, 2 * widest_gap(directions) + kBinRadius)));
  const bool two_sided = has_lower_side(layout);
  const std::vector<Vec3> counted = counted_views(two_sided ? seen : from_both_sides(seen));
  const auto near = [&](const Vec3& view) {
    return std::ranges::any_of(counted, [&](const Vec3& w) { return w.z * view.z > 0 && dot(w, view) >= least; });
  };
  SeenPairs pairs;
  std::array<bool, 2> side{};
  for (const Vec3& w : counted) side[w.z < 0] = true;
  const std::array<size_t, 2> upright{most_upright(directions, false), most_upright(directions, true)};
  for (uint32_t v = 0; v < directions.size(); ++v) {
    const bool below = directions[v].z < 0;
    if (near(directions[v]) || (side[below] && v == upright[below])) pairs.views.push_back(v);
  }
  for (uint32_t l = 0; l < layout.lights().size(); ++l) {
    if (two_sided || side[unit_direction(layout.lights()[l]).z < 0]) pairs.lights.push_back(l);
  }
  return pairs;
}

std::unique_ptr<const BtfMeasurement> scene_btf(const BtfMeasurement& fine, uint32_t halvings, SeenPairs pairs) {
  return std::make_unique<const SceneBtf>(fine, halvings, std::move(pairs));
}

std::vector<float> halved_image(std::vector<float> image, TexelGrid grid, uint32_t channels, uint32_t halvings) {
  for (; halvings > 0; --halvings) {
    image = half_image(image, grid.width, grid.height, channels);
    grid.width = half_of(grid.width);
    grid.height = half_of(grid.height);
  }
  return image;
}

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
