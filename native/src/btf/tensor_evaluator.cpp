#include "btf/tensor_evaluator.h"

#include <algorithm>

#include "btf/seen_levels.h"
#include "btf/tensor_factors.h"

namespace velour {
namespace {

AlignedArray<float> zeros(size_t count) {
  AlignedArray<float> floats(count);
  std::fill_n(floats.data(), count, 0.0f);
  return floats;
}

/// One level, ready to be looked up.
struct Level {
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
  std::vector<uint8_t> records;  // TensorTexels
  std::optional<Relief> relief;
  std::vector<Vec2> slope;  // [texel], where there is a relief
};

/// Where the parts of a TensorTables begin: those of one cluster and node.
size_t table_place(const TensorTables& t, size_t node, size_t cluster) {
  return node * t.table_node() + cluster * t.table_cluster();
}

/// Whether a side's cores are multiplied with all views ahead of time.
bool ahead(const TensorTables& t, size_t views) {
  return views * t.table_node() * sizeof(float) <= TensorEvaluator::kMostTableBytes;
}

TensorTables sizes_of(const TensorSide& side) {
  TensorTables t{};
  t.clusters = static_cast<uint32_t>(side.clusters.size());
  t.rank = side.rank.texel;
  t.color_rank = side.rank.color;
  t.light_rank = padded_rank(side.rank.light);
  t.view_rank = side.rank.view;
  return t;
}

}  // namespace

struct TensorEvaluator::Side {
  Side(const TensorBtf& btf, const TensorSide& from);
  void scale_from(const TensorSide& from);
  void fill_cluster(const TensorSide& from, const TensorFactors& factors, size_t cluster);
  /// A cluster's core times one number for each rank of the views, added to its place of `table`.
  void add_node(const TensorSide& from, const TensorFactors& factors, const float* weight, float* to) const;

  std::vector<Vec3> view_directions, light_directions;
  bool whole_table;
  TensorTables tables;
  DirectionMesh views, lights;
  uint32_t members;
  AlignedArray<float> least, step, color, view, table, light;
  std::vector<Level> levels;
};

TensorEvaluator::Side::Side(const TensorBtf& btf, const TensorSide& from)
    : view_directions(directions_on_side(btf.layout.views(), from.view_below)),
      light_directions(directions_on_side(btf.layout.lights(), from.light_below)),
      whole_table(ahead(sizes_of(from), view_directions.size())),
      tables(sizes_of(from)),
      views(view_directions),
      lights(light_directions),
      members(from.members),
      least(zeros(size_t{tables.clusters} * padded_rank(tables.rank))),
      step(zeros(least.size())),
      color(zeros(size_t{tables.clusters} * 3 * tables.color_rank)),
      view(zeros(whole_table ? 1 : view_directions.size() * tables.clusters * tables.view_rank)),
      table(zeros((whole_table ? view_directions.size() : tables.view_rank) * tables.table_node())),
      light(zeros(light_directions.size() * tables.clusters * tables.light_rank)) {
  scale_from(from);
  for (size_t c = 0; c < tables.clusters; ++c) fill_cluster(from, TensorFactors(btf, from.clusters[c]), c);
  tables.least = least.data();
  tables.step = step.data();
  tables.color = color.data();
  tables.view = whole_table ? nullptr : view.data();
  tables.table = table.data();
  tables.light = light.data();
  for (const TensorLevel& level : from.levels) levels.emplace_back(btf, from, level);
}

void TensorEvaluator::Side::scale_from(const TensorSide& from) {
  const size_t padded = padded_rank(tables.rank);
  for (size_t c = 0; c < tables.clusters; ++c) {
    for (size_t r = 0; r < tables.rank; ++r) {
      least.data()[c * padded + r] = from.clusters[c].scale[r].least;
      step.data()[c * padded + r] = from.clusters[c].scale[r].step;
    }
  }
}

void TensorEvaluator::Side::add_node(const TensorSide& from, const TensorFactors& factors, const float* weight,
                                     float* to) const {
  const float* core = factors.core.data();
  for (uint32_t r = 0; r < tables.rank; ++r, to += tables.table_row()) {
    for (uint32_t i = 0; i < tables.view_rank; ++i) {
      for (uint32_t j = 0; j < from.rank.light; ++j) {
        for (uint32_t k = 0; k < tables.color_rank; ++k) to[k * tables.light_rank + j] += weight[i] * *core++;
      }
    }
  }
}

void TensorEvaluator::Side::fill_cluster(const TensorSide& from, const TensorFactors& factors, size_t cluster) {
  const size_t rank = tables.view_rank;
  std::copy(factors.color.begin(), factors.color.end(), color.data() + cluster * factors.color.size());
  for (size_t l = 0; l < light_directions.size(); ++l) {
    std::copy_n(factors.light.data() + l * from.rank.light, from.rank.light,
                light.data() + (l * tables.clusters + cluster) * tables.light_rank);
  }
  for (size_t v = 0; v < view_directions.size(); ++v) {
    const float* const row = factors.view.data() + v * rank;
    if (whole_table) {
      add_node(from, factors, row, table.data() + table_place(tables, v, cluster));
    } else {
      std::copy_n(row, rank, view.data() + (v * tables.clusters + cluster) * rank);
    }
  }
  if (whole_table) return;
  for (size_t i = 0; i < rank; ++i) {
    std::vector<float> one(rank, 0.0f);
    one[i] = 1;
    add_node(from, factors, one.data(), table.data() + table_place(tables, i, cluster));
  }
}

TensorEvaluator::TensorEvaluator(std::shared_ptr<const TensorBtf> btf) : btf_(std::move(btf)) {
  for (const TensorSide& side : btf_->sides) sides_.push_back(std::make_unique<const Side>(*btf_, side));
}

TensorEvaluator::~TensorEvaluator() = default;

std::optional<uint32_t> TensorEvaluator::side(bool view_below, bool light_below) const {
  return serving_side(*btf_, view_below, light_below);
}

void TensorEvaluator::begin(uint32_t side, const Vec3& wv, TensorPoint& point) const {
  std::fill_n(point.met, sides_[side]->tables.clusters, TensorPoint::kNotMet);
  point.count = 0;
  point.side = side;
  point.wv = wv;
  point.slope = Vec2(0.0f);
}

void TensorEvaluator::add(const Vec2& uv, float level, float weight, TensorPoint& point) const {
  const Side& side = *sides_[point.side];
  const SeenLevels seen = seen_levels(side.levels, uv, level, point.wv);
  const auto add_level = [&](const Level& from, const Vec2& texel, float w) {
    const TensorTexels texels{from.records.data(), from.width, from.height, side.members, side.tables.rank};
    add_tensor_texels(texels, texel, w, point);
    point.slope += w * from.slope_at(texel);
  };
  add_level(side.levels[seen.fine], seen.texel, weight * (1 - seen.part));
  if (seen.part > 0) add_level(side.levels[seen.fine + 1], seen.coarse, weight * seen.part);
}

void TensorEvaluator::finish(TensorPoint& point) const {
  const Side& side = *sides_[point.side];
  contract_view(side.tables, side.views.at(point.wv), point);
}

TensorEvaluator::Light TensorEvaluator::light(uint32_t side, const Vec3& wl) const {
  return sides_[side]->lights.at(wl);
}

Rgb TensorEvaluator::value(const TensorPoint& point, const Light& light) const {
  const Vec3 sum = contract_light(sides_[point.side]->tables, light, point);
  return {expanded(btf_->companding, sum.r), expanded(btf_->companding, sum.g), expanded(btf_->companding, sum.b)};
}

}  // namespace velour
