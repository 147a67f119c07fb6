// Highway compiles this file once for each instruction set.
#include "btf/model/tensor_evaluator.h"

#include <algorithm>

#include "image/texels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/model/tensor_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Block = hn::CappedTag<float, kRankPadding>;

/// Index of a cluster among those met; appends a new one.
HWY_INLINE uint32_t number_of(uint8_t cluster, uint32_t padded, TensorPoint& point) {
  if (point.met[cluster] != TensorPoint::kNotMet) return point.met[cluster];
  const uint32_t number = point.count++;
  point.met[cluster] = static_cast<uint16_t>(number);
  point.cluster[number] = cluster;
  point.share[number] = 0;
  std::fill_n(point.coefficient + number * padded, padded, 0.0f);
  return number;
}

/// Beyond the rank, bytes of the data that follows are added too; their scale is 0.
HWY_INLINE void add_bytes(const uint8_t* bytes, uint32_t padded, float weight, float* to) {
  const Block d;
  const hn::RebindToSigned<Block> di;
  const hn::Rebind<uint8_t, Block> du;
  const auto w = hn::Set(d, weight);
  for (uint32_t r = 0; r < padded; r += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto values = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(du, bytes + r)));
    hn::Store(hn::MulAdd(values, w, hn::Load(d, to + r)), d, to + r);
  }
}

HWY_FLATTEN void add_texels(const TensorTexels& texels, const Vec2& texel, float weight, TensorPoint& point) {
  const BilinearTexels corners = bilinear_at(texel, texels.width, texels.height);
  const uint32_t padded = padded_rank(texels.rank);
  for (size_t i = 0; i < 4; ++i) {
    const uint8_t* const member = texels.records + size_t{corners.index[i]} * texels.stride();
    const uint8_t* const bytes = member + texels.members;
    const float w = weight * corners.weight[i];
    for (uint32_t k = 0; k < texels.members; ++k) {
      const uint32_t number = number_of(member[k], padded, point);
      point.share[number] += w;
      add_bytes(bytes + k * texels.rank, padded, w, point.coefficient + number * padded);
    }
  }
}

/// The entries of the table's first index to sum, with their weights.
struct Nodes {
  uint32_t count = 0;
  uint32_t index[TensorBtf::kMaxRank];
  float weight[TensorBtf::kMaxRank];

  void add(uint32_t node, float w) {
    index[count] = node;
    weight[count++] = w;
  }
};

/// The nodes are views, the same for all clusters.
HWY_INLINE void take_views(const DirectionMesh::Weights& view, Nodes& nodes) {
  for (size_t i = 0; i < 3; ++i) {
    if (view.weight[i] > 0) nodes.add(view.index[i], view.weight[i]);
  }
}

/// The nodes are view ranks, weighted by the cluster's interpolated view factor.
HWY_INLINE void take_ranks(const TensorTables& t, const DirectionMesh::Weights& view, uint32_t cluster, Nodes& nodes) {
  nodes.count = 0;
  for (uint32_t i = 0; i < t.view_rank; ++i) {
    float w = 0;
    for (size_t v = 0; v < 3; ++v) {
      w += view.weight[v] * t.view[(size_t{view.index[v]} * t.clusters + cluster) * t.view_rank + i];
    }
    nodes.add(i, w);
  }
}

/// Converts bytes to coefficients.
HWY_INLINE void scale(const TensorTables& t, uint32_t cluster, float share, float* coefficient) {
  const Block d;
  const uint32_t padded = padded_rank(t.rank);
  const float *least = t.least + cluster * padded, *step = t.step + cluster * padded;
  const auto all = hn::Set(d, share);
  for (uint32_t r = 0; r < padded; r += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto constant = hn::Mul(all, hn::Load(d, least + r));
    hn::Store(hn::MulAdd(hn::Load(d, coefficient + r), hn::Load(d, step + r), constant), d, coefficient + r);
  }
}

/// Sums a piece of `kVectors` vectors of the table's rows, starting at `table`, over nodes and texel ranks.
template <size_t kVectors>
HWY_INLINE void sum_piece(const TensorTables& t, const Nodes& nodes, const float* coefficient, const float* table,
                          float* to) {
  const Block d;
  const size_t lanes = hn::Lanes(d);
  hn::Vec<Block> sum[kVectors], of_node[kVectors];
  for (size_t i = 0; i < kVectors; ++i) sum[i] = hn::Zero(d);
  for (uint32_t n = 0; n < nodes.count; ++n) {
    const float* row = table + nodes.index[n] * t.table_node();
    for (size_t i = 0; i < kVectors; ++i) of_node[i] = hn::Zero(d);
    for (uint32_t r = 0; r < t.rank; ++r, row += t.table_row()) {
      const auto c = hn::Set(d, coefficient[r]);
      for (size_t i = 0; i < kVectors; ++i) of_node[i] = hn::MulAdd(c, hn::Load(d, row + i * lanes), of_node[i]);
    }
    const auto weight = hn::Set(d, nodes.weight[n]);
    for (size_t i = 0; i < kVectors; ++i) sum[i] = hn::MulAdd(of_node[i], weight, sum[i]);
  }
  for (size_t i = 0; i < kVectors; ++i) hn::Store(sum[i], d, to + i * lanes);
}

/// Sums whole rows, [color rank][padded light rank], in pieces that fit the registers: memory is read in order, and
/// each coefficient once per piece.
HWY_INLINE void sum_rows(const TensorTables& t, const Nodes& nodes, const float* coefficient, const float* table,
                         float* to) {
  const size_t lanes = hn::Lanes(Block()), row = t.table_row();
  size_t j = 0;
  for (; j + 4 * lanes <= row; j += 4 * lanes) sum_piece<4>(t, nodes, coefficient, table + j, to + j);
  for (; j + 2 * lanes <= row; j += 2 * lanes) sum_piece<2>(t, nodes, coefficient, table + j, to + j);
  for (; j < row; j += lanes) sum_piece<1>(t, nodes, coefficient, table + j, to + j);
}

/// Computes a cluster's rows for the three channels.
HWY_INLINE void contract_cluster(const TensorTables& t, const Nodes& nodes, uint32_t cluster, const float* coefficient,
                                 float* row) {
  const Block d;
  HWY_ALIGN float sums[3 * TensorBtf::kMaxRank];
  sum_rows(t, nodes, coefficient, t.table + cluster * t.table_cluster(), sums);
  const float* const color = t.color + size_t{cluster} * 3 * t.color_rank;
  for (uint32_t c = 0; c < 3; ++c, row += t.width) {
    for (uint32_t j = 0; j < t.width; j += static_cast<uint32_t>(hn::Lanes(d))) {
      auto sum = hn::Zero(d);
      for (uint32_t k = 0; k < t.color_rank; ++k) {
        const auto factor = hn::Set(d, color[c * t.color_rank + k]);
        sum = hn::MulAdd(hn::Load(d, sums + k * t.width + j), factor, sum);
      }
      hn::Store(sum, d, row + j);
    }
  }
}

/// Computes a cluster's rows for the three channels in TensorOrder::pairs: coefficients times colors. Coefficients
/// beyond the rank are 0, so what is written past the rank is 0 at the end of a row and overwritten elsewhere.
HWY_INLINE void spread_cluster(const TensorTables& t, uint32_t cluster, const float* coefficient, float* row) {
  const Block d;
  const uint32_t lanes = static_cast<uint32_t>(hn::Lanes(d)), padded = padded_rank(t.rank);
  const float* color = t.color + size_t{cluster} * 3 * t.color_rank;
  for (uint32_t c = 0; c < 3; ++c, row += t.width) {
    std::fill_n(row + t.width - kRankPadding, kRankPadding, 0.0f);
    for (uint32_t k = 0; k < t.color_rank; ++k) {
      const auto factor = hn::Set(d, *color++);
      for (uint32_t r = 0; r < padded; r += lanes) {
        hn::StoreU(hn::Mul(hn::Load(d, coefficient + r), factor), d, row + k * t.rank + r);
      }
    }
  }
}

HWY_FLATTEN void with_view(const TensorTables& t, const DirectionMesh::Weights& view, TensorPoint& point) {
  Nodes nodes;
  if (t.order == TensorOrder::views) take_views(view, nodes);
  point.view = view;
  for (uint32_t m = 0; m < point.count; ++m) {
    const uint32_t cluster = point.cluster[m];
    float *const coefficient = point.coefficient + m * padded_rank(t.rank), *const row = point.row + m * 3 * t.width;
    scale(t, cluster, point.share[m], coefficient);
    if (t.order == TensorOrder::ranks) take_ranks(t, view, cluster, nodes);
    if (t.order == TensorOrder::pairs) {
      spread_cluster(t, cluster, coefficient, row);
    } else {
      contract_cluster(t, nodes, cluster, coefficient, row);
    }
  }
}

/// Lights in groups of three; a group shares one view weight.
template <size_t kThrees>
struct Threes {
  hn::Vec<Block> weight[3 * kThrees];
  const float* from[3 * kThrees];

  /// Interpolated factor of a block of a cluster's row.
  HWY_INLINE hn::Vec<Block> at(size_t place) const {
    const Block d;
    auto total = hn::Zero(d);
    for (size_t i = 0; i < 3 * kThrees; i += 3) {
      const auto first = hn::Mul(hn::Load(d, from[i] + place), weight[i]);
      const auto second = hn::MulAdd(hn::Load(d, from[i + 1] + place), weight[i + 1], first);
      total = hn::Add(total, hn::MulAdd(hn::Load(d, from[i + 2] + place), weight[i + 2], second));
    }
    return total;
  }
};

/// Sets the three lights of one view, or those shared by all views.
template <size_t kThrees>
HWY_INLINE void take_lights(const TensorTables& t, uint32_t view, float share, const DirectionMesh::Weights& light,
                            size_t three, Threes<kThrees>& threes) {
  for (size_t i = 0; i < 3; ++i) {
    threes.weight[3 * three + i] = hn::Set(Block(), share * light.weight[i]);
    threes.from[3 * three + i] = t.light + (size_t{view} * t.lights + light.index[i]) * t.light_node();
  }
}

template <size_t kThrees>
HWY_INLINE Vec3 sum_of_rows(const TensorTables& t, const Threes<kThrees>& threes, const TensorPoint& point) {
  const Block d;
  auto red = hn::Zero(d), green = red, blue = red;
  for (uint32_t m = 0; m < point.count; ++m) {
    const size_t first = size_t{point.cluster[m]} * t.width;
    const float* const row = point.row + m * 3 * t.width;
    for (uint32_t j = 0; j < t.width; j += static_cast<uint32_t>(hn::Lanes(d))) {
      const auto factor = threes.at(first + j);
      red = hn::MulAdd(factor, hn::Load(d, row + j), red);
      green = hn::MulAdd(factor, hn::Load(d, row + t.width + j), green);
      blue = hn::MulAdd(factor, hn::Load(d, row + 2 * t.width + j), blue);
    }
  }
  const auto total = [&](auto sum) { return hn::GetLane(hn::SumOfLanes(d, sum)); };
  return {total(red), total(green), total(blue)};
}

HWY_FLATTEN Vec3 under_light(const TensorTables& t, const DirectionMesh::Weights& light, const TensorPoint& point) {
  if (t.order == TensorOrder::pairs) {
    Threes<3> threes;
    for (size_t i = 0; i < 3; ++i) take_lights(t, point.view.index[i], point.view.weight[i], light, i, threes);
    return sum_of_rows(t, threes, point);
  }
  Threes<1> threes;
  take_lights(t, 0, 1, light, 0, threes);
  return sum_of_rows(t, threes, point);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(add_texels);
HWY_EXPORT(with_view);
HWY_EXPORT(under_light);

void add_tensor_texels(const TensorTexels& texels, const Vec2& texel, float weight, TensorPoint& point) {
  VELOUR_SIMD_DISPATCH(add_texels)(texels, texel, weight, point);
}

void contract_view(const TensorTables& tables, const DirectionMesh::Weights& view, TensorPoint& point) {
  VELOUR_SIMD_DISPATCH(with_view)(tables, view, point);
}

Vec3 contract_light(const TensorTables& tables, const DirectionMesh::Weights& light, const TensorPoint& point) {
  return VELOUR_SIMD_DISPATCH(under_light)(tables, light, point);
}

}  // namespace velour
#endif
