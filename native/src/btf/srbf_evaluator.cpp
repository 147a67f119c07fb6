#include "btf/srbf_evaluator.h"

#include <algorithm>
#include <cmath>

#include "btf/bilinear_texels.h"

namespace velour {
namespace {

uint32_t padded(size_t count) {
  return static_cast<uint32_t>((count + kHalfRowPadding - 1) / kHalfRowPadding * kHalfRowPadding);
}

std::span<const MultivariateLobe> tile_lobes(const SrbfSide& side) { return {side.lobes.data(), side.tile_lobes}; }
std::span<const MultivariateLobe> texel_lobes(const SrbfSide& side) {
  return std::span(side.lobes).subspan(side.tile_lobes);
}

Relief relief_of(const SrbfBtf& btf, const SrbfLevel& level) {
  std::vector<float> heights(level.relief.size());
  halves_to_floats(level.relief, heights);
  return {level.width, level.height, heights, tile_aspect(btf.grid)};
}

}  // namespace

SrbfEvaluator::Side::Side(const SrbfBtf& btf, const SrbfSide& side) : tile(tile_lobes(side)), texel(texel_lobes(side)) {
  axis1 = tile.padded() + texel.padded();
  slope = axis1 + static_cast<uint32_t>(side.lobe[1].size() + side.lobe[2].size());
  stride = padded(slope + 2);
  for (size_t a = 0; a < 2; ++a) {
    for (const uint16_t lobe : side.lobe[a + 1]) scatter[a].push_back(place_of(lobe));
  }
  const size_t coefficients = side.coefficients(), first = side.lobe[0].size();
  for (const SrbfLevel& level : side.levels) {
    const size_t texels = size_t{level.width} * level.height;
    Level& to = levels.emplace_back(Level{relief_of(btf, level), AlignedArray<HalfBits>(texels * stride)});
    std::fill_n(to.record.data(), to.record.size(), HalfBits{0});
    for (size_t t = 0; t < texels; ++t) {
      const HalfBits* const from = level.value.data() + t * coefficients;
      HalfBits* const record = to.record.data() + t * stride;
      for (size_t k = 0; k < first; ++k) record[place_of(static_cast<uint16_t>(k))] = from[k];
      std::copy(from + first, from + coefficients, record + axis1);
      const Vec2 slopes =
          to.relief.slope(static_cast<uint32_t>(t % level.width), static_cast<uint32_t>(t / level.width));
      const float values[] = {slopes.x, slopes.y};
      floats_to_halves(values, {record + slope, 2});
    }
  }
}

uint32_t SrbfEvaluator::Side::place_of(uint16_t lobe) const {
  return lobe < tile.size() ? lobe : tile.padded() + lobe - tile.size();
}

SrbfEvaluator::SrbfEvaluator(std::shared_ptr<const SrbfBtf> btf) : btf_(std::move(btf)) {
  for (const SrbfSide& side : btf_->sides) sides_.emplace_back(*btf_, side);
}

std::optional<uint32_t> SrbfEvaluator::side(bool view_below, bool light_below) const {
  for (uint32_t i = 0; i < btf_->sides.size(); ++i) {
    const SrbfSide& side = btf_->sides[i];
    if (side.view_below == view_below && side.light_below == light_below) return i;
  }
  for (const SharedSide& shared : btf_->shared) {
    if (shared.view_below == view_below && shared.light_below == light_below) return shared.side;
  }
  return std::nullopt;
}

void SrbfEvaluator::begin(uint32_t side, const Vec3& wv, SrbfPoint& point) const {
  point.side = side;
  point.wv = wv;
  std::fill_n(point.record, sides_[side].stride, 0.0f);
}

void SrbfEvaluator::add(const Vec2& uv, float level, float weight, SrbfPoint& point) const {
  const Side& side = sides_[point.side];
  const float place = std::clamp(level, 0.0f, static_cast<float>(side.levels.size() - 1));
  const auto fine = static_cast<size_t>(place);
  const float part = place - static_cast<float>(fine);
  const Vec2 inside = std::isfinite(uv.x + uv.y) ? uv - glm::floor(uv) : Vec2(0.0f);
  // Once for both levels: where the finer relief is met.
  const Vec2 seen = side.levels[fine].relief.seen(inside, point.wv);
  add_bilinear(side.levels[fine], side.stride, seen, weight * (1 - part), point);
  if (part > 0) add_bilinear(side.levels[fine + 1], side.stride, seen, weight * part, point);
}

void SrbfEvaluator::add_bilinear(const Level& level, uint32_t stride, const Vec2& place, float weight,
                                 SrbfPoint& point) const {
  std::array<WeightedHalves, 4> corner;
  const BilinearTexels texels = bilinear_texels(place, level.relief.width(), level.relief.height());
  for (size_t i = 0; i < 4; ++i) {
    corner[i] = {level.record.data() + size_t{texels.index[i]} * stride, weight * texels.weight[i]};
  }
  add_half_rows(corner, stride, point.record);
}

void SrbfEvaluator::finish(SrbfPoint& point) const {
  const Side& side = sides_[point.side];
  const float* value = point.record + side.axis1;
  for (size_t a = 0; a < 2; ++a) {
    std::fill_n(point.color[a], side.axis1, 0.0f);
    for (const uint32_t place : side.scatter[a]) point.color[a][place] = *value++;
  }
  point.to_normal = to_normal(normal_of({point.record[side.slope], point.record[side.slope + 1]}));
}

Rgb SrbfEvaluator::value(const SrbfPoint& point, const Vec3& wl) const {
  const Side& side = sides_[point.side];
  const LobeArguments at({wl, point.wv});
  const Vec3 sum = lobe_sums({LobesAt{&side.tile, at}, LobesAt{&side.texel, at.turned(point.to_normal)}},
                             {point.record, point.color[0], point.color[1]});
  const Vec3 color = btf_->axes * sum;
  return {expanded(btf_->companding, color.r), expanded(btf_->companding, color.g),
          expanded(btf_->companding, color.b)};
}

void srbf_image(const SrbfEvaluator& evaluator, const DirectionPair& pair, std::vector<float>& rgb) {
  const TexelGrid& grid = evaluator.btf().grid;
  rgb.assign(grid.texels() * 3, 0.0f);
  const auto side = evaluator.side(pair.wv.z < 0, pair.wl.z < 0);
  if (!side) return;
  const Vec3 wv(pair.wv.x, pair.wv.y, std::abs(pair.wv.z)), wl(pair.wl.x, pair.wl.y, std::abs(pair.wl.z));
  SrbfPoint point;
  for (size_t t = 0; t < grid.texels(); ++t) {
    evaluator.begin(*side, wv, point);
    const Vec2 uv((static_cast<float>(t % grid.width) + 0.5f) / static_cast<float>(grid.width),
                  (static_cast<float>(t / grid.width) + 0.5f) / static_cast<float>(grid.height));
    evaluator.add(uv, 0, 1, point);
    evaluator.finish(point);
    const Rgb f = evaluator.value(point, wl);
    for (int c = 0; c < 3; ++c) rgb[t * 3 + static_cast<size_t>(c)] = f[c];
  }
}

}  // namespace velour
