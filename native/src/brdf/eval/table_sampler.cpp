// Highway compiles this file once for each instruction set.
#include "brdf/eval/table_sampler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/eval/table_sampler.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

#ifndef VELOUR_MATERIAL_TABLE_LAYOUT
#define VELOUR_MATERIAL_TABLE_LAYOUT
namespace velour {

/// Layout of a node's table: densities of d at the row edges and the masses up to them, densities per (d, azimuth) at
/// the cell corners, and their integrals over the columns up to and including each, which are linear in d.
struct TableLayout {
  using G = TableGrid;
  static constexpr int kCorners = (G::kRows + 1) * G::kColumns;
  static constexpr int kDensity = 0, kBelow = G::kRowsPadded, kValue = 2 * G::kRowsPadded, kSum = kValue + kCorners;
  static constexpr int kSize = kSum + kCorners;
};

struct RowEdges {
  float low[TableGrid::kRows], height[TableGrid::kRows], inverse_height[TableGrid::kRows];

  constexpr RowEdges() : low(), height(), inverse_height() {
    for (int row = 0; row < TableGrid::kRows; ++row) {
      low[row] = TableGrid::row_edge(row);
      height[row] = TableGrid::row_edge(row + 1) - low[row];
      inverse_height[row] = 1 / height[row];
    }
  }
};
inline constexpr RowEdges kRowEdges;

}  // namespace velour
#endif

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using G = TableGrid;
using L = TableLayout;

constexpr float kColumnWidth = 4.0f / G::kColumns;  // the azimuth runs from 0 to 4 around the square

/// The mixture's mass up to each row.
template <int kNodes>
HWY_INLINE void mix_rows(const TablePoint& point, float (&below)[G::kRows]) {
  const hn::CappedTag<float, 16> d;
  for (int at = 0; at < G::kRows; at += static_cast<int>(hn::Lanes(d))) {
    const auto of = [&](int k) { return hn::LoadU(d, point.table[k] + L::kBelow + at); };
    auto sum = hn::Mul(hn::Set(d, point.weight[0]), of(0));
    for (int k = 1; k < kNodes; ++k) sum = hn::MulAdd(hn::Set(d, point.weight[k]), of(k), sum);
    hn::Store(sum, d, below + at);
  }
}

/// 2 (k / kRows)^4.
template <class D, class V = hn::Vec<D>, class I>
HWY_INLINE V row_edge(D d, I row) {
  const V s = hn::Mul(hn::ConvertTo(d, row), hn::Set(d, 1.0f / G::kRows)), q = hn::Mul(s, s);
  return hn::Mul(hn::Add(q, q), q);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V mix(V a, V b, V t) {
  return hn::MulAdd(t, hn::Sub(b, a), a);
}

/// Density of the mixture at one corner per lane.
template <int kNodes, class D, class V = hn::Vec<D>, class I>
HWY_INLINE V mixed(D d, const TablePoint& point, I corner) {
  V sum = hn::Mul(hn::Set(d, point.weight[0]), hn::GatherIndex(d, point.table[0] + L::kValue, corner));
  for (int i = 1; i < kNodes; ++i) {
    sum = hn::MulAdd(hn::Set(d, point.weight[i]), hn::GatherIndex(d, point.table[i] + L::kValue, corner), sum);
  }
  return sum;
}

/// t in [0, 1] where the integral of the line from `a` to `b`, a t + (b - a) t^2 / 2, reaches `mass`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V line_inverse(D d, V a, V b, V mass) {
  const V twice = hn::Mul(hn::Set(d, 2.0f), hn::Max(mass, hn::Zero(d)));
  const V root = hn::Sqrt(hn::Max(hn::MulAdd(hn::Sub(b, a), twice, hn::Mul(a, a)), hn::Zero(d)));
  const V t = hn::Div(twice, hn::Max(hn::Add(a, root), hn::Set(d, 1e-37f)));
  return hn::Min(t, hn::Set(d, 1.0f));
}

template <int kNodes, class D>
HWY_INLINE hn::Vec<D> density(D d, const TablePoint& point, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z) {
  using V = hn::Vec<D>;
  const hn::RebindToSigned<D> di;
  const V one = hn::Set(d, 1.0f);
  const auto component = [&](const Vec3& along) {
    return hn::MulAdd(hn::Set(d, along.x), x, hn::MulAdd(hn::Set(d, along.y), y, hn::Mul(hn::Set(d, along.z), z)));
  };
  const V gx = hn::Sub(x, hn::Set(d, point.axis.x)), gy = hn::Sub(y, hn::Set(d, point.axis.y)),
          gz = hn::Sub(z, hn::Set(d, point.axis.z));
  const V fall = hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(gx, gx, hn::MulAdd(gy, gy, hn::Mul(gz, gz))));
  const V s = hn::Sqrt(hn::Sqrt(hn::Mul(hn::Set(d, 0.5f), fall)));
  const auto row = hn::Min(hn::ConvertTo(di, hn::Mul(s, hn::Set(d, G::kRows))), hn::Set(di, G::kRows - 1));
  const V low = row_edge(d, row), height = hn::Sub(row_edge(d, hn::Add(row, hn::Set(di, 1))), low);
  const V t = hn::Min(hn::Max(hn::Div(hn::Sub(fall, low), height), hn::Zero(d)), one);

  const V p = component(point.tangent), q = component(point.bitangent);
  const V length = hn::Add(hn::Abs(p), hn::Abs(q)), scale = hn::Div(one, hn::Max(length, hn::Set(d, 1e-20f)));
  const V along = hn::Mul(p, scale);
  const V way = hn::IfThenElse(hn::Lt(q, hn::Zero(d)), hn::Add(hn::Set(d, 3.0f), along), hn::Sub(one, along));
  const V position = hn::Mul(way, hn::Set(d, 1 / kColumnWidth));
  const auto column = hn::Min(hn::ConvertTo(di, position), hn::Set(di, G::kColumns - 1));
  const V share = hn::Sub(position, hn::ConvertTo(d, column));

  const auto first = hn::ShiftLeft<G::kColumnBits>(row);
  const auto next = hn::And(hn::Add(column, hn::Set(di, 1)), hn::Set(di, G::kColumns - 1));
  const auto between = [&](int rows_below) {
    const auto from = hn::Add(first, hn::Set(di, rows_below * G::kColumns));
    return mix<D>(mixed<kNodes>(d, point, hn::Add(from, column)), mixed<kNodes>(d, point, hn::Add(from, next)), share);
  };
  // d phi / d way = length^2 / (p^2 + q^2).
  const V round = hn::MulAdd(along, along, hn::Mul(hn::Mul(q, scale), hn::Mul(q, scale)));
  return hn::Mul(mix<D>(between(0), between(1), t), hn::Max(round, hn::Set(d, 0.5f)));
}

/// Number of entries at most x among `count` increasing numbers.
HWY_INLINE int count_up_to(const float* numbers, int count, float x) {
  const hn::CappedTag<float, 16> d;
  size_t found = 0;
  for (int at = 0; at < count; at += static_cast<int>(hn::Lanes(d))) {
    found += hn::CountTrue(d, hn::Le(hn::Load(d, numbers + at), hn::Set(d, x)));
  }
  return static_cast<int>(found);
}

/// Samples in progress, one per lane.
struct alignas(64) TableDraws {
  static constexpr int kLanes = DirectionBatch::kCapacity;
  float u[kLanes], v[kLanes];
  float low[kLanes], height[kLanes], inverse_height[kLanes];  // of the row, in d
  float first[kLanes], last[kLanes];                          // densities at the ends of the row, then of the cell
  float rest[kLanes];                                         // mass up to the sample in the row, then in the cell
  float fall[kLanes];                                         // d
  float share[kLanes], target[kLanes];  // weight of the row's end; integral over the columns up to the sample
  float column[kLanes];
  int row[kLanes];
};

template <int kNodes>
HWY_INLINE void choose_row(const TablePoint& point, const float (&below)[G::kRows], int i, TableDraws& draws) {
  const int row = count_up_to(below, G::kRows, draws.u[i]) - 1;
  float first = 0, last = 0;
  for (int k = 0; k < kNodes; ++k) {
    const float* const density = point.table[k] + L::kDensity + row;
    first += point.weight[k] * density[0];
    last += point.weight[k] * density[1];
  }
  draws.row[i] = row;
  draws.low[i] = kRowEdges.low[row];
  draws.height[i] = kRowEdges.height[row];
  draws.inverse_height[i] = kRowEdges.inverse_height[row];
  draws.first[i] = first;
  draws.last[i] = last;
  draws.rest[i] = draws.u[i] - below[row];
}

/// Computes d in the row, and the target integral that selects the column.
template <class D>
HWY_INLINE void place_in_rows(D d, int at, TableDraws& draws) {
  const auto first = hn::Load(d, draws.first + at), last = hn::Load(d, draws.last + at);
  const auto mass = hn::Mul(hn::Load(d, draws.rest + at), hn::Load(d, draws.inverse_height + at));
  const auto t = line_inverse(d, first, last, mass);
  hn::Store(t, d, draws.share + at);
  hn::Store(hn::MulAdd(t, hn::Load(d, draws.height + at), hn::Load(d, draws.low + at)), d, draws.fall + at);
  hn::Store(hn::Mul(hn::Load(d, draws.v + at), mix<D>(first, last, t)), d, draws.target + at);
}

template <int kNodes>
HWY_INLINE void choose_column(const TablePoint& point, int i, TableDraws& draws) {
  const hn::CappedTag<float, 16> d;
  const float t = draws.share[i];
  const int from = draws.row[i] * G::kColumns;
  float upper[kNodes], lower[kNodes];  // weights of the row's ends
  for (int k = 0; k < kNodes; ++k) {
    lower[k] = point.weight[k] * t;
    upper[k] = point.weight[k] - lower[k];
  }
  alignas(64) float sums[G::kColumns];
  for (int at = 0; at < G::kColumns; at += static_cast<int>(hn::Lanes(d))) {
    auto sum = hn::Zero(d);
    for (int k = 0; k < kNodes; ++k) {
      const float* const row = point.table[k] + L::kSum + from + at;
      sum = hn::MulAdd(hn::Set(d, upper[k]), hn::LoadU(d, row), sum);
      sum = hn::MulAdd(hn::Set(d, lower[k]), hn::LoadU(d, row + G::kColumns), sum);
    }
    hn::Store(sum, d, sums + at);
  }
  const int column = std::min(count_up_to(sums, G::kColumns, draws.target[i]), G::kColumns - 1);
  const int next = (column + 1) % G::kColumns;
  float first = 0, last = 0;
  for (int k = 0; k < kNodes; ++k) {
    const float* const row = point.table[k] + L::kValue + from;
    first += upper[k] * row[column] + lower[k] * row[G::kColumns + column];
    last += upper[k] * row[next] + lower[k] * row[G::kColumns + next];
  }
  draws.column[i] = static_cast<float>(column);
  draws.first[i] = first;
  draws.last[i] = last;
  draws.rest[i] = (draws.target[i] - (column > 0 ? sums[column - 1] : 0.0f)) / kColumnWidth;
}

template <class D>
HWY_INLINE void place_in_columns(D d, const TablePoint& point, int at, const TableDraws& draws, DirectionBatch& w) {
  using V = hn::Vec<D>;
  const V one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), fall = hn::Load(d, draws.fall + at);
  const V share =
      line_inverse(d, hn::Load(d, draws.first + at), hn::Load(d, draws.last + at), hn::Load(d, draws.rest + at));
  const V way = hn::Mul(hn::Add(hn::Load(d, draws.column + at), share), hn::Set(d, kColumnWidth));
  const auto upper = hn::Lt(way, two);
  const V along = hn::IfThenElse(upper, hn::Sub(one, way), hn::Sub(way, hn::Set(d, 3.0f)));
  const V rise = hn::Sub(one, hn::Abs(along)), across = hn::IfThenElse(upper, rise, hn::Neg(rise));
  const V sine_sq = hn::Max(hn::Mul(fall, hn::Sub(two, fall)), hn::Zero(d));
  const V scale = hn::Sqrt(hn::Div(sine_sq, hn::MulAdd(along, along, hn::Mul(across, across))));
  const V p = hn::Mul(scale, along), q = hn::Mul(scale, across), z = hn::Sub(one, fall);
  const auto sum = [&](float tangent, float bitangent, float axis) {
    return hn::MulAdd(hn::Set(d, tangent), p, hn::MulAdd(hn::Set(d, bitangent), q, hn::Mul(hn::Set(d, axis), z)));
  };
  hn::Store(sum(point.tangent.x, point.bitangent.x, point.axis.x), d, w.x + at);
  hn::Store(sum(point.tangent.y, point.bitangent.y, point.axis.y), d, w.y + at);
  hn::Store(sum(point.tangent.z, point.bitangent.z, point.axis.z), d, w.z + at);
}

template <int kNodes, class D>
HWY_INLINE void directions(D d, const TablePoint& point, TableDraws& draws, int count, DirectionBatch& w) {
  alignas(64) float below[G::kRows];
  mix_rows<kNodes>(point, below);
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int padded = (count + lanes - 1) / lanes * lanes;
  for (int i = 0; i < padded; ++i) choose_row<kNodes>(point, below, i, draws);
  for (int at = 0; at < padded; at += lanes) place_in_rows(d, at, draws);
  for (int i = 0; i < padded; ++i) choose_column<kNodes>(point, i, draws);
  for (int at = 0; at < padded; at += lanes) place_in_columns(d, point, at, draws, w);
}

template <int kNodes>
HWY_INLINE void densities(const TablePoint& point, const DirectionBatch& w, ScalarBatch& pdf) {
  const hn::CappedTag<float, 16> d;
  for (int at = 0; at < w.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto x = hn::Load(d, w.x + at), y = hn::Load(d, w.y + at), z = hn::Load(d, w.z + at);
    hn::Store(density<kNodes>(d, point, x, y, z), d, pdf.v + at);
  }
}

void densities_simd(const TablePoint& point, const DirectionBatch& w, ScalarBatch& pdf) {
  return point.count == 2 ? densities<2>(point, w, pdf) : densities<4>(point, w, pdf);
}

float density_simd(const TablePoint& point, const Vec3& w) {
  const hn::CappedTag<float, 1> d;
  const auto x = hn::Set(d, w.x), y = hn::Set(d, w.y), z = hn::Set(d, w.z);
  return hn::GetLane(point.count == 2 ? density<2>(d, point, x, y, z) : density<4>(d, point, x, y, z));
}

void directions_simd(const TablePoint& point, std::span<const Vec2> u, DirectionBatch& w) {
  TableDraws draws;
  const auto count = static_cast<int>(u.size());
  const auto draw = [&](auto d) {
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < (count + lanes - 1) / lanes * lanes; ++i) {
      const Vec2 number = i < count ? u[static_cast<size_t>(i)] : Vec2(0.5f);
      draws.u[i] = number.x;
      draws.v[i] = number.y;
    }
    return point.count == 2 ? directions<2>(d, point, draws, count, w) : directions<4>(d, point, draws, count, w);
  };
  if (count == 1) return draw(hn::CappedTag<float, 1>());
  return count <= 8 ? draw(hn::CappedTag<float, 8>()) : draw(hn::CappedTag<float, 16>());
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cassert>

#include "base/parallel.h"
#include "material/material.h"
#include "math/sphere/frame.h"

namespace velour {

HWY_EXPORT(densities_simd);
HWY_EXPORT(density_simd);
HWY_EXPORT(directions_simd);

namespace {

using G = TableGrid;
using L = TableLayout;

constexpr int kRadiusCells = 64, kSquareCells = 16;  // cells of the nodes
constexpr float kLowestNode = 0.01f;                 // minimum view cosine of a node
constexpr float kMargin = 0.02f;                     // raises the defensive cosine: horizons differ between the nodes
constexpr float kNoMass = 1e-20f;                    // mass of a black node, negligible beside any other

/// Frame about the mirror direction: the frame about the normal, rotated there without twist.
void set_frame(const Vec3& wv, TablePoint& point) {
  const Vec3 m = point.axis = reflected(wv);
  const float a = 1 / (1 + m.z), b = -m.x * m.y * a;
  point.tangent = {1 - m.x * m.x * a, b, -m.x};
  point.bitangent = {b, 1 - m.y * m.y * a, -m.y};
}

/// Frame about the mirror direction whose tangent lies in the plane of incidence, so that it turns with the view.
void set_frame_of_plane(const Vec3& wv, const ViewPlace& place, TablePoint& point) {
  point.axis = reflected(wv);
  point.tangent = {wv.z * place.cos_phi, wv.z * place.sin_phi, place.sine};
  point.bitangent = {-place.sin_phi, place.cos_phi, 0};
}

/// Point of the square |x| + |y| = 1 at azimuth coordinate `way`, in the frame's plane.
Vec2 on_square(float way) {
  const float along = way < 2 ? 1 - way : way - 3;
  return {along, way < 2 ? 1 - std::abs(along) : std::abs(along) - 1};
}

Vec3 corner_direction(const TablePoint& frame, int row, int column) {
  const Vec2 q = glm::normalize(on_square(4.0f * static_cast<float>(column) / G::kColumns));
  const float d = G::row_edge(row), sine = std::sqrt(std::max(d * (2 - d), 0.0f));
  return glm::normalize(sine * (q.x * frame.tangent + q.y * frame.bitangent) + (1 - d) * frame.axis);
}

}  // namespace

TableSampler::TableSampler(bool isotropic, const Luminance& luminance)
    : isotropic_(isotropic),
      nodes_(isotropic, isotropic ? kRadiusCells : kSquareCells),
      tables_(static_cast<size_t>(nodes_.count()) * L::kSize) {
  parallel_fill(static_cast<size_t>(nodes_.count()),
                [&](size_t node) { fill_node(luminance, static_cast<int>(node)); });
}

TableSampler::TableSampler(const Material& material)
    : TableSampler(material.isotropic(), [&](const Vec3& wv, auto wl, auto f_cos) {
        ScratchArena arena;
        const PreparedBrdf* const point = material.prepare(wv, arena);
        RgbBatch f;
        ScalarBatch unused;
        for (size_t k = 0; k < wl.size(); ++k) {
          point->eval(wl[k], f, unused);
          for (int i = 0; i < wl[k].count; ++i) f_cos[k].v[i] = luminance(f.get(i)) * std::max(wl[k].z[i], 0.0f);
        }
      }) {}

void TableSampler::fill_node(const Luminance& luminance, int node) {
  TablePoint frame;
  Vec3 wv = nodes_.view(node);
  wv.z = std::max(wv.z, kLowestNode);
  wv = glm::normalize(wv);
  set_frame(wv, frame);
  std::vector<DirectionBatch> wl((G::kRows + 1) * G::kColumns / DirectionBatch::kCapacity + 1);
  std::vector<ScalarBatch> f_cos(wl.size());
  const auto place = [](int row, int column) { return static_cast<size_t>(row * G::kColumns + column); };
  for (int row = 0; row <= G::kRows; ++row) {
    for (int column = 0; column < G::kColumns; ++column) {
      wl[place(row, column) / DirectionBatch::kCapacity].push(corner_direction(frame, row, column));
    }
  }
  for (DirectionBatch& batch : wl) batch.pad();
  luminance(wv, wl, f_cos);

  float* const table = tables_.data() + static_cast<size_t>(node) * L::kSize;
  float* const value = table + L::kValue;
  const auto fill = [&](auto&& density) {
    double mass = 0;
    for (int row = 0; row <= G::kRows; ++row) {
      float* const values = value + row * G::kColumns;
      double sum = 0;
      for (int column = 0; column < G::kColumns; ++column) {
        const Vec2 q = on_square(4.0f * static_cast<float>(column) / G::kColumns);
        values[column] = density(row, column) / glm::dot(q, q);
        sum += static_cast<double>(values[column]);
      }
      table[L::kDensity + row] = static_cast<float>(sum * 4 / G::kColumns);
      if (row == 0) continue;
      const auto height = static_cast<double>(G::row_edge(row) - G::row_edge(row - 1));
      mass += 0.5 * height *
              (static_cast<double>(table[L::kDensity + row - 1]) + static_cast<double>(table[L::kDensity + row]));
      table[L::kBelow + row] = static_cast<float>(mass);
    }
    return static_cast<float>(mass);
  };
  const auto at = [](auto& batches, size_t i) -> auto& { return batches[i / DirectionBatch::kCapacity]; };
  const auto reflected = [&](int row, int column) {
    const size_t i = place(row, column);
    const float f = at(f_cos, i).v[i % DirectionBatch::kCapacity];
    return f > 0 ? std::min(f, 1e20f) : 0.0f;  // NaN counts as 0
  };
  const float mass = std::max(fill(reflected), kNoMass);
  const float defence = mass * kDefensiveShare / (1 - kDefensiveShare) / (kPi * (1 + kMargin) * (1 + kMargin));
  fill([&](int row, int column) {
    const size_t i = place(row, column);
    const float z = at(wl, i).z[i % DirectionBatch::kCapacity];
    return reflected(row, column) + defence * std::max(z + kMargin, 0.0f);
  });
  for (int row = 0; row <= G::kRows; ++row) {
    const float* const values = value + row * G::kColumns;
    float* const sums = table + L::kSum + row * G::kColumns;
    double sum = 0;
    for (int column = 0; column < G::kColumns; ++column) {
      const float next = values[(column + 1) % G::kColumns];
      sum += 2.0 / G::kColumns * (static_cast<double>(values[column]) + static_cast<double>(next));
      sums[column] = static_cast<float>(sum);
    }
  }
}

void TableSampler::prepare(const Vec3& wv, TablePoint& point) const {
  const ViewPlace place(wv);
  const NodeWeights nodes = nodes_.at(place);
  point.count = nodes.count;
  float total = 0;
  for (int i = 0; i < nodes.count; ++i) {
    point.table[i] = tables_.data() + static_cast<size_t>(nodes.node[i]) * L::kSize;
    total += nodes.weight[i] * point.table[i][L::kBelow + G::kRows];
  }
  for (int i = 0; i < nodes.count; ++i) point.weight[i] = nodes.weight[i] / total;
  point.mass = total;
  return isotropic_ ? set_frame_of_plane(wv, place, point) : set_frame(wv, point);
}

bool TableSampler::resolve(const Vec3& wv, std::span<const Peak> peaks) const {
  TablePoint point;
  prepare(wv, point);
  const auto mass = static_cast<double>(point.mass);
  double variance = 0;
  for (const Peak& peak : peaks) {
    const double weight = peak.f_cos / (mass * static_cast<double>(std::max(pdf(point, peak.wl), 1e-30f)));
    if (weight > kResolved) variance += weight * peak.mass / mass;
  }
  return variance <= kMaxVariance;
}

void TableSampler::sample(const TablePoint& point, std::span<const Vec2> u, DirectionBatch& wl) {
  assert(u.size() <= DirectionBatch::kCapacity);
  wl.count = static_cast<int>(u.size());
  VELOUR_SIMD_DISPATCH(directions_simd)(point, u, wl);
}

void TableSampler::pdf(const TablePoint& point, const DirectionBatch& wl, ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(densities_simd)(point, wl, pdf);
}

float TableSampler::pdf(const TablePoint& point, const Vec3& wl) {
  return VELOUR_SIMD_DISPATCH(density_simd)(point, wl);
}

}  // namespace velour
#endif
