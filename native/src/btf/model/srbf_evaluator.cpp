#include "btf/model/srbf_evaluator.h"

#include <algorithm>
#include <cmath>

#include "image/texels.h"

namespace velour {
namespace {

constexpr float kSlopeStep = Relief::kSteepest / 32767;  // step of the lower byte of a slope
constexpr uint32_t kBlock = MultivariateLobes::kPadding;

/// A texel coefficient, by index, with its axis and lobe.
struct Term {
  size_t coefficient;
  int axis;
  MultivariateLobe lobe;
};

/// Terms of the lobes in the tile's frame, or of those in the normal's frame.
std::vector<Term> terms(const SrbfSide& side, bool tile) {
  std::vector<Term> terms;
  size_t coefficient = 0;
  for (size_t a = 0; a < 3; ++a) {
    for (const uint16_t lobe : side.lobe[a]) {
      if ((lobe < side.tile_lobes) == tile) terms.push_back({coefficient, static_cast<int>(a), side.lobes[lobe]});
      ++coefficient;
    }
  }
  return terms;
}

MultivariateLobes lobes_of(const std::vector<Term>& terms) {
  std::vector<MultivariateLobe> lobes;
  for (const Term& term : terms) lobes.push_back(term.lobe);
  return MultivariateLobes(lobes);
}

uint32_t padded(size_t count) {
  return static_cast<uint32_t>((count + kByteRowPadding - 1) / kByteRowPadding * kByteRowPadding);
}

Relief relief_of(const SrbfBtf& btf, const SrbfLevel& level) {
  std::vector<float> heights(level.relief.size());
  halves_to_floats(level.relief, heights);
  return {level.width, level.height, heights, tile_aspect(btf.grid)};
}

void write_slope(const Vec2& slope, uint8_t* to) {
  for (int i = 0; i < 2; ++i) {
    const auto steps = static_cast<uint32_t>(std::lround(slope[i] / kSlopeStep) + 32768);
    *to++ = static_cast<uint8_t>(steps >> 8);
    *to++ = static_cast<uint8_t>(steps & 0xff);
  }
}

}  // namespace

SrbfEvaluator::Side::Side(const SrbfBtf& btf, const SrbfSide& side)
    : tile(lobes_of(terms(side, true))),
      texel(lobes_of(terms(side, false))),
      stride(padded(tile.padded() + texel.size() + 4)),
      least(aligned_zeros(stride)),
      step(aligned_zeros(stride)),
      color(aligned_zeros(size_t{3} * (tile.padded() + texel.padded()))) {
  std::vector<uint32_t> place(side.coefficients());
  uint32_t next = 0;
  for (const bool in_tile : {true, false}) {
    for (const Term& term : terms(side, in_tile)) {
      place[term.coefficient] = next;
      least.data()[next] = side.scale[term.coefficient].least;
      step.data()[next] = side.scale[term.coefficient].step;
      float* const first = color.data() + next / kBlock * 3 * kBlock + next % kBlock;
      for (int c = 0; c < 3; ++c) first[static_cast<uint32_t>(c) * kBlock] = btf.axes[term.axis][c];
      ++next;
    }
    next = tile.padded();
  }
  for (const uint32_t s : {slope(), slope() + 2}) {
    least.data()[s] = -32768 * kSlopeStep;
    step.data()[s] = 256 * kSlopeStep;
    step.data()[s + 1] = kSlopeStep;
  }
  for (const SrbfLevel& level : side.levels) add_level(relief_of(btf, level), level, place);
}

void SrbfEvaluator::Side::add_level(Relief relief, const SrbfLevel& from, const std::vector<uint32_t>& place) {
  const size_t texels = from.relief.size(), coefficients = place.size();
  Level& to = levels.emplace_back(Level{std::move(relief), AlignedArray<uint8_t>(texels * stride)});
  std::fill_n(to.record.data(), to.record.size(), uint8_t{0});
  for (size_t t = 0; t < texels; ++t) {
    uint8_t* const record = to.record.data() + t * stride;
    for (size_t k = 0; k < coefficients; ++k) record[place[k]] = from.value[t * coefficients + k];
    const auto x = static_cast<uint32_t>(t % from.width), y = static_cast<uint32_t>(t / from.width);
    write_slope(to.relief.slope(x, y), record + slope());
  }
}

SrbfEvaluator::SrbfEvaluator(std::shared_ptr<const SrbfBtf> btf) : btf_(std::move(btf)) {
  for (const SrbfSide& side : btf_->sides) sides_.emplace_back(*btf_, side);
}

std::optional<uint32_t> SrbfEvaluator::side(bool view_below, bool light_below) const {
  return serving_side(*btf_, view_below, light_below);
}

void SrbfEvaluator::begin(uint32_t side, const Vec3& wv, SrbfPoint& point) const {
  point.side = side;
  point.wv = wv;
  // The value of zero bytes, to which add() accumulates.
  std::copy_n(sides_[side].least.data(), sides_[side].stride, point.record);
}

void SrbfEvaluator::add(const Vec2& uv, float level, float weight, SrbfPoint& point) const {
  const Side& side = sides_[point.side];
  const SeenLevels seen = seen_levels(side.levels, uv, level, point.wv);
  const auto add_level = [&](const Level& from, const Vec2& texel, float w) {
    const ByteTexels texels{from.record.data(), from.relief.width(), from.relief.height(), side.stride};
    add_bilinear_bytes(texels, texel, w, side.step.data(), point.record);
  };
  add_level(side.levels[seen.fine], seen.texel, weight * (1 - seen.part));
  if (seen.part > 0) add_level(side.levels[seen.fine + 1], seen.coarse, weight * seen.part);
}

void SrbfEvaluator::finish(SrbfPoint& point) const {
  const float* const s = point.record + sides_[point.side].slope();
  point.to_normal = to_normal(Vec2(s[0] + s[1], s[2] + s[3]));
}

Rgb SrbfEvaluator::value(const SrbfPoint& point, const Vec3& wl) const {
  const Side& side = sides_[point.side];
  const Vec3 color =
      lobe_sums({side.tile, side.texel, side.color.data()}, {wl, point.wv}, point.to_normal, point.record);
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
