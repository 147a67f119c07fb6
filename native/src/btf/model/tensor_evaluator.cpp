#include "btf/model/tensor_evaluator.h"

#include <algorithm>

#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_btf.h"
#include "btf/model/tensor_contraction.h"

namespace velour {
/// One mip level, prepared for lookups.
struct TensorEvaluator::Level {
  Level(const TensorBtf& btf, const TensorSide& side, const TensorLevel& from)
      : width(from.width), height(from.height) {
    const size_t texels = size_t{width} * height, value = size_t{side.members} * side.rank.texel;
    records.reserve(texels * (side.members + value) + kRankPadding);
    for (size_t t = 0; t < texels; ++t) {
      const uint8_t *member = from.member.data() + t * side.members, *values = from.value.data() + t * value;
      records.insert(records.end(), member, member + side.members);
      records.insert(records.end(), values, values + value);
    }
    records.resize(records.size() + kRankPadding);
    if (from.relief.empty()) return;
    relief.emplace(width, height, heights_of(from), tile_aspect(btf.grid));
    for (size_t t = 0; t < texels; ++t) {
      slope.push_back(relief->slope(static_cast<uint32_t>(t % width), static_cast<uint32_t>(t / width)));
    }
  }

  Vec2 texels() const { return {width, height}; }
  Vec2 seen_texel(const Vec2& place, const Vec3& wv) const {
    return relief ? relief->seen_texel(place, wv) : place * texels() - 0.5f;
  }
  Vec2 slope_at(const Vec2& texel) const {
    Vec2 sum(0.0f);
    if (!relief) return sum;
    const BilinearTexels corners = bilinear_at(texel, width, height);
    for (size_t i = 0; i < 4; ++i) sum += corners.weight[i] * slope[corners.index[i]];
    return sum;
  }

  uint32_t width, height;
  std::vector<uint8_t> records;  // see TensorTexels
  std::optional<Relief> relief;
  std::vector<Vec2> slope;  // [texel]; empty without a relief
};

struct TensorEvaluator::Side {
  Side(const TensorBtf& btf, const TensorSide& from, uint64_t most_bytes)
      : views(directions_on_side(btf.layout.views(), from.view_below)),
        lights(directions_on_side(btf.layout.lights(), from.light_below)),
        contraction(btf, from, most_bytes),
        members(from.members) {
    for (const TensorLevel& level : from.levels) levels.emplace_back(btf, from, level);
  }

  DirectionMesh views, lights;
  TensorContraction contraction;
  uint32_t members;
  std::vector<Level> levels;
};

TensorEvaluator::TensorEvaluator(std::shared_ptr<const TensorBtf> btf, uint64_t most_bytes) : btf_(std::move(btf)) {
  for (const TensorSide& side : btf_->sides) sides_.push_back(std::make_unique<const Side>(*btf_, side, most_bytes));
}

TensorEvaluator::~TensorEvaluator() = default;

std::optional<uint32_t> TensorEvaluator::side(bool view_below, bool light_below) const {
  return serving_side(*btf_, view_below, light_below);
}

void TensorEvaluator::begin(uint32_t side, const Vec3& wv, TensorPoint& point) const {
  std::fill_n(point.met, sides_[side]->contraction.tables().clusters, TensorPoint::kNotMet);
  point.count = 0;
  point.side = side;
  point.wv = wv;
  point.slope = Vec2(0.0f);
}

void TensorEvaluator::add(const Vec2& uv, float level, float weight, TensorPoint& point) const {
  const Side& side = *sides_[point.side];
  const SeenLevels seen = seen_levels(side.levels, uv, level, point.wv);
  const auto add_level = [&](const Level& from, const Vec2& texel, float w) {
    const TensorTexels texels{from.records.data(), from.width, from.height, side.members,
                              side.contraction.tables().rank};
    add_tensor_texels(texels, texel, w, point);
    point.slope += w * from.slope_at(texel);
  };
  add_level(side.levels[seen.fine], seen.texel, weight * (1 - seen.part));
  if (seen.part > 0) add_level(side.levels[seen.fine + 1], seen.coarse, weight * seen.part);
}

void TensorEvaluator::finish(TensorPoint& point) const {
  const Side& side = *sides_[point.side];
  contract_view(side.contraction.tables(), side.views.at(point.wv), point);
}

TensorEvaluator::Light TensorEvaluator::light(uint32_t side, const Vec3& wl) const {
  return sides_[side]->lights.at(wl);
}

Rgb TensorEvaluator::value(const TensorPoint& point, const Light& light) const {
  const Vec3 sum = contract_light(sides_[point.side]->contraction.tables(), light, point);
  return {expanded(btf_->companding, sum.r), expanded(btf_->companding, sum.g), expanded(btf_->companding, sum.b)};
}

}  // namespace velour
