#include "btf/model/tensor_evaluator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/transposed.h"
#include "btf/measure/relief.h"
#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_btf.h"
#include "image/texels.h"
#include "math/sphere/direction_mesh.h"

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

namespace {

uint32_t count_on_side(const std::vector<PolarAngles>& directions, bool below) {
  return static_cast<uint32_t>(directions_on_side(directions, below).size());
}

/// Whether a TensorPoint has room for rows of this width.
bool holds_rows(const TensorTables& t) { return t.light_node() <= TensorPoint::kMaxRanks; }

TensorTables sizes_of(const TensorSide& side, TensorOrder order, uint32_t lights) {
  TensorTables t{};
  t.order = order;
  t.clusters = static_cast<uint32_t>(side.clusters.size());
  t.rank = side.rank.texel;
  t.color_rank = side.rank.color;
  t.view_rank = side.rank.view;
  t.width = padded_rank(order == TensorOrder::pairs ? t.rank * t.color_rank : side.rank.light);
  t.lights = lights;
  return t;
}

size_t table_size(const TensorTables& t, size_t views) {
  if (t.order == TensorOrder::pairs) return 0;
  return (t.order == TensorOrder::views ? views : t.view_rank) * t.table_node();
}

size_t light_size(const TensorTables& t, size_t views) {
  return (t.order == TensorOrder::pairs ? views : 1) * t.lights * t.light_node();
}

size_t view_size(const TensorTables& t, size_t views) {
  return t.order == TensorOrder::ranks ? views * t.clusters * t.view_rank : 0;
}

uint64_t table_bytes(const TensorTables& t, size_t views) {
  return (table_size(t, views) + light_size(t, views) + view_size(t, views)) * sizeof(float);
}

TensorTables chosen(const TensorSide& side, size_t views, uint32_t lights, uint64_t most_bytes) {
  for (const TensorOrder order : {TensorOrder::pairs, TensorOrder::views}) {
    const TensorTables t = sizes_of(side, order, lights);
    if (table_bytes(t, views) <= most_bytes && holds_rows(t)) return t;
  }
  return sizes_of(side, TensorOrder::ranks, lights);
}

/// Offset of the rows of one node and cluster in TensorTables::table.
size_t table_place(const TensorTables& t, size_t node, size_t cluster) {
  return node * t.table_node() + cluster * t.table_cluster();
}

/// Adds a cluster's core, contracted over the view ranks with `weight`, to `to`: [texel rank][color rank] rows over the
/// light ranks, `row` numbers apart.
void add_node(const TensorSide& side, const TensorFactors& factors, const float* weight, size_t row, float* to) {
  const float* core = factors.core.data();
  for (uint32_t r = 0; r < side.rank.texel; ++r, to += side.rank.color * row) {
    for (uint32_t i = 0; i < side.rank.view; ++i) {
      for (uint32_t j = 0; j < side.rank.light; ++j) {
        for (uint32_t k = 0; k < side.rank.color; ++k) to[k * row + j] += weight[i] * *core++;
      }
    }
  }
}

}  // namespace

TensorContraction::TensorContraction(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes)
    : views_(count_on_side(btf.layout.views(), side.view_below)),
      tables_(chosen(side, views_, count_on_side(btf.layout.lights(), side.light_below), most_bytes)),
      least_(aligned_zeros(size_t{tables_.clusters} * padded_rank(tables_.rank))),
      step_(aligned_zeros(least_.size())),
      color_(aligned_zeros(size_t{tables_.clusters} * 3 * tables_.color_rank)),
      view_(aligned_zeros(view_size(tables_, views_))),
      table_(aligned_zeros(table_size(tables_, views_))),
      light_(aligned_zeros(light_size(tables_, views_))) {
  scale_from(side);
  for (size_t c = 0; c < tables_.clusters; ++c) fill_cluster(side, TensorFactors(btf, side.clusters[c]), c);
  tables_.least = least_.data();
  tables_.step = step_.data();
  tables_.color = color_.data();
  tables_.view = view_.data();
  tables_.table = table_.data();
  tables_.light = light_.data();
}

uint64_t TensorContraction::bytes(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes) {
  const uint32_t views = count_on_side(btf.layout.views(), side.view_below);
  const uint32_t lights = count_on_side(btf.layout.lights(), side.light_below);
  return table_bytes(chosen(side, views, lights, most_bytes), views);
}

void TensorContraction::scale_from(const TensorSide& side) {
  const size_t padded = padded_rank(tables_.rank);
  for (size_t c = 0; c < tables_.clusters; ++c) {
    for (size_t r = 0; r < tables_.rank; ++r) {
      least_.data()[c * padded + r] = side.clusters[c].scale[r].least;
      step_.data()[c * padded + r] = side.clusters[c].scale[r].step;
    }
  }
}

void TensorContraction::fill_cluster(const TensorSide& side, const TensorFactors& factors, size_t cluster) {
  std::copy(factors.color.begin(), factors.color.end(), color_.data() + cluster * factors.color.size());
  if (tables_.order == TensorOrder::pairs) return fill_pairs(side, factors, cluster);
  fill_lights(side, factors, cluster);
  const size_t rank = tables_.view_rank;
  const auto fill_node = [&](size_t node, const float* weight) {
    add_node(side, factors, weight, tables_.width, table_.data() + table_place(tables_, node, cluster));
  };
  if (tables_.order == TensorOrder::views) {
    for (size_t v = 0; v < views_; ++v) fill_node(v, factors.view.data() + v * rank);
    return;
  }
  for (size_t v = 0; v < views_; ++v) {
    std::copy_n(factors.view.data() + v * rank, rank, view_.data() + (v * tables_.clusters + cluster) * rank);
  }
  for (size_t i = 0; i < rank; ++i) {
    std::vector<float> one(rank, 0.0f);
    one[i] = 1;
    fill_node(i, one.data());
  }
}

void TensorContraction::fill_lights(const TensorSide& side, const TensorFactors& factors, size_t cluster) {
  const size_t rank = side.rank.light;
  for (size_t l = 0; l < tables_.lights; ++l) {
    std::copy_n(factors.light.data() + l * rank, rank,
                light_.data() + l * tables_.light_node() + cluster * tables_.width);
  }
}

void TensorContraction::fill_pairs(const TensorSide& side, const TensorFactors& factors, size_t cluster) {
  const size_t rank = side.rank.light, colors = side.rank.color, lights = tables_.lights;
  // Transposed, so that the inner loop runs along the lights.
  const std::vector<float> light = transposed(factors.light, rank);
  std::vector<float> node, sum(lights);
  for (size_t v = 0; v < views_; ++v) {
    node.assign(side.rank.texel * colors * rank, 0.0f);
    add_node(side, factors, factors.view.data() + v * side.rank.view, rank, node.data());
    float* const to = light_.data() + v * lights * tables_.light_node() + cluster * tables_.width;
    for (size_t row = 0; row < side.rank.texel * colors; ++row) {
      std::fill(sum.begin(), sum.end(), 0.0f);
      for (size_t j = 0; j < rank; ++j) {
        const float factor = node[row * rank + j];
        for (size_t l = 0; l < lights; ++l) sum[l] += factor * light[j * lights + l];
      }
      const size_t r = row / colors, k = row % colors;
      for (size_t l = 0; l < lights; ++l) to[l * tables_.light_node() + k * side.rank.texel + r] = sum[l];
    }
  }
}

namespace {

/// The row of a factor, interpolated between directions.
std::vector<float> between(const std::vector<float>& factor, size_t rank, const DirectionMesh::Weights& at) {
  std::vector<float> row(rank, 0.0f);
  for (size_t i = 0; i < 3; ++i) {
    const float* from = factor.data() + at.index[i] * rank;
    for (size_t r = 0; r < rank; ++r) row[r] += at.weight[i] * from[r];
  }
  return row;
}

/// A cluster's contribution to a texel for a pair: a linear function of the texel's bytes, per channel.
struct ByteFunction {
  Vec3 constant{0.0f};
  std::vector<float> slope;  // [channel][rank]
};

Vec3 mirrored_up(const Vec3& w) { return {w.x, w.y, std::abs(w.z)}; }

}  // namespace

struct TensorImages::Side {
  Side(const TensorBtf& btf, const TensorSide& s)
      : side(s),
        views(directions_on_side(btf.layout.views(), s.view_below)),
        lights(directions_on_side(btf.layout.lights(), s.light_below)) {
    for (const TensorBtfCluster& cluster : s.clusters) clusters.emplace_back(btf, cluster);
    const TensorLevel& level = s.levels.at(0);
    if (!level.relief.empty()) relief.emplace(level.width, level.height, heights_of(level), tile_aspect(btf.grid));
  }

  ByteFunction function_of(size_t cluster, const DirectionMesh::Weights& view,
                           const DirectionMesh::Weights& light) const {
    const TensorFactors& from = clusters[cluster];
    const TensorSide::Ranks& rank = side.rank;
    const std::vector<float> v = between(from.view, rank.view, view), l = between(from.light, rank.light, light);
    ByteFunction function{Vec3(0.0f), std::vector<float>(size_t{3} * rank.texel)};
    const float* core = from.core.data();
    for (size_t r = 0; r < rank.texel; ++r) {
      Vec3 basis(0.0f);
      for (size_t i = 0; i < rank.view; ++i) {
        for (size_t j = 0; j < rank.light; ++j) {
          for (size_t k = 0; k < rank.color; ++k) {
            const float part = v[i] * l[j] * *core++;
            for (size_t c = 0; c < 3; ++c) basis[static_cast<int>(c)] += part * from.color[c * rank.color + k];
          }
        }
      }
      const ByteScale& scale = side.clusters[cluster].scale[r];
      function.constant += scale.least * basis;
      for (size_t c = 0; c < 3; ++c) function.slope[c * rank.texel + r] = scale.step * basis[static_cast<int>(c)];
    }
    return function;
  }

  /// The sums of all texels, [row][column], in linear Rec. 709.
  std::vector<Vec3> sums_of(const DirectionMesh::Weights& view, const DirectionMesh::Weights& light) const {
    std::vector<ByteFunction> functions;
    for (size_t c = 0; c < clusters.size(); ++c) functions.push_back(function_of(c, view, light));
    const TensorLevel& level = side.levels[0];
    const size_t rank = side.rank.texel;
    std::vector<Vec3> sums(size_t{level.width} * level.height, Vec3(0.0f));
    for (size_t i = 0; i < level.member.size(); ++i) {
      const ByteFunction& function = functions[level.member[i]];
      const uint8_t* bytes = level.value.data() + i * rank;
      Vec3 sum = function.constant;
      for (size_t c = 0; c < 3; ++c) {
        for (size_t r = 0; r < rank; ++r) {
          sum[static_cast<int>(c)] += function.slope[c * rank + r] * static_cast<float>(bytes[r]);
        }
      }
      sums[i / side.members] += sum;
    }
    return sums;
  }

  Vec3 sum_at(const std::vector<Vec3>& sums, size_t texel, const Vec3& wv) const {
    if (!relief) return sums[texel];
    const uint32_t width = relief->width(), height = relief->height();
    const Vec2 place((static_cast<float>(texel % width) + 0.5f) / static_cast<float>(width),
                     (static_cast<float>(texel / width) + 0.5f) / static_cast<float>(height));
    const BilinearTexels corners = bilinear_at(relief->seen_texel(place, wv), width, height);
    Vec3 sum(0.0f);
    for (size_t i = 0; i < 4; ++i) sum += corners.weight[i] * sums[corners.index[i]];
    return sum;
  }

  const TensorSide& side;
  DirectionMesh views, lights;
  std::vector<TensorFactors> clusters;
  std::optional<Relief> relief;
};

struct TensorImages::Impl {
  const TensorBtf& btf;
  std::vector<Side> sides;
};

TensorImages::TensorImages(const TensorBtf& btf) {
  auto impl = std::make_unique<Impl>(Impl{btf, {}});
  for (const TensorSide& side : btf.sides) impl->sides.emplace_back(btf, side);
  impl_ = std::move(impl);
}

TensorImages::~TensorImages() = default;

void TensorImages::image(const DirectionPair& pair, std::vector<float>& rgb) const {
  const TensorBtf& btf = impl_->btf;
  rgb.assign(btf.grid.texels() * 3, 0.0f);
  const auto number = serving_side(btf, pair.wv.z < 0, pair.wl.z < 0);
  if (!number) return;
  const Side& side = impl_->sides[*number];
  const Vec3 wv = mirrored_up(pair.wv), wl = mirrored_up(pair.wl);
  const std::vector<Vec3> sums = side.sums_of(side.views.at(wv), side.lights.at(wl));
  for (size_t t = 0; t < sums.size(); ++t) {
    const Vec3 sum = side.sum_at(sums, t, wv);
    for (int c = 0; c < 3; ++c) rgb[3 * t + static_cast<size_t>(c)] = expanded(btf.companding, sum[c]);
  }
}

}  // namespace velour
