#include "btf/model/tensor_contraction.h"

#include <algorithm>

#include "base/transposed.h"
#include "btf/model/tensor_btf.h"

namespace velour {
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

}  // namespace velour
