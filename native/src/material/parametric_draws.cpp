// Highway compiles this file once for each instruction set.
#include "material/parametric_draws.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/parametric_draws.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "material/store_draws-inl.h"
#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int kNodes>
HWY_INLINE void add_draws(const float* const (&row)[4], const float (&weight)[4], WarpedMixture& m) {
  using P = ParametricDraws;
  const hn::CappedTag<float, 8> d;  // padded is a multiple of it
  using V = hn::Vec<decltype(d)>;
  for (int at = 0; at < m.padded; at += static_cast<int>(hn::Lanes(d))) {
    const auto column = [&](int which) {
      const int from = which * m.padded + at;
      V sum = hn::Mul(hn::Set(d, weight[0]), hn::LoadU(d, row[0] + from));
      for (int i = 1; i < kNodes; ++i) sum = hn::MulAdd(hn::Set(d, weight[i]), hn::LoadU(d, row[i] + from), sum);
      return sum;
    };
    const Vector<V> center{hn::Add(hn::Load(d, m.x + at), column(P::kOffsetX)),
                           hn::Add(hn::Load(d, m.y + at), column(P::kOffsetY)),
                           hn::Add(hn::Load(d, m.z + at), column(P::kOffsetZ))};
    const V bandwidth = hn::Mul(hn::Load(d, m.bandwidth + at), column(P::kBandwidthRatio));
    store_draws(d, center, bandwidth, column(P::kBelow), column(P::kUpTo), at, m);
  }
}

void add_draws_simd(const float* table, const NodeWeights& nodes, WarpedMixture& m) {
  const float* row[4];
  for (int i = 0; i < nodes.count; ++i) row[i] = table + nodes.node[i] * ParametricDraws::kColumns * m.padded;
  return nodes.count == 2 ? add_draws<2>(row, nodes.weight, m) : add_draws<4>(row, nodes.weight, m);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>

#include "job/parallel.h"
#include "material/draw_fit.h"
#include "material/idle_lobes.h"
#include "sphere/frame.h"
#include "srbf/lobe_tree.h"

namespace velour {

HWY_EXPORT(add_draws_simd);

namespace {

constexpr double kDefensiveShare = 0.05;  // method 6.2
constexpr int kRadiusCells = 64, kSquareCells = 16;

/// A lobe of the mixture, as scalar code has it.
WarpedLobe lobe_of(const WarpedMixture& m, int j) {
  return {m.half[j] > 0 ? LobeSpace::half : LobeSpace::light,
          {m.s_xx[j], m.s_xy[j], m.s_yy[j]},
          glm::normalize(Vec3d(m.x[j], m.y[j], m.z[j])),
          m.bandwidth[j],
          {m.r[j], m.g[j], m.b[j]}};
}

std::vector<WarpedLobe> lobes_of(const WarpedMixture& m) {
  std::vector<WarpedLobe> lobes;
  for (int j = 0; j < m.count; ++j) lobes.push_back(lobe_of(m, j));
  return lobes;
}

bool has(uint32_t set, size_t lobe) { return (set >> lobe & 1) != 0; }

/// The fit of some lobes; the others are not drawn.
DrawFit fit_of(const std::vector<WarpedLobe>& lobes, uint32_t chosen, const Vec3d& wv) {
  std::vector<WarpedLobe> some;
  for (size_t j = 0; j < lobes.size(); ++j) {
    if (has(chosen, j)) some.push_back(lobes[j]);
  }
  DrawFit fit = fit_draws(some, wv);
  auto next = fit.lobes.begin();
  auto all = drawn_as_they_are(lobes);
  for (size_t j = 0; j < all.size(); ++j) {
    if (has(chosen, j)) all[j] = *next++;
  }
  fit.lobes = std::move(all);
  return fit;
}

ProposalLobes few_lobes(const DrawFit& fit) {
  GaussianLobes lobes;
  ProposalLobes few;
  few.cosine = static_cast<float>(fit.mass * fit.cosine / kPiD);
  for (const DrawnLobe& lobe : fit.lobes) {
    if (!(lobe.probability > 0)) continue;
    const double integral = kernel_integral(Kernel::gaussian, lobe.light_bandwidth);
    const double amplitude = fit.mass * lobe.probability / integral;
    lobes.add({Vec3(lobe.light_center), static_cast<float>(lobe.light_bandwidth), static_cast<float>(amplitude)});
  }
  constexpr GaussianLobe kEverywhere{{0, 0, 1}, 0, 1};
  for (const GaussianLobe& lobe : LobeTree(lobes).cut(kEverywhere, ProposalLobes::kCapacity)) {
    few.lobe[few.count++] = lobe;
  }
  return few;
}

Vec3 mirror(const Vec3& w) { return {-w.x, -w.y, w.z}; }

}  // namespace

ParametricDraws::ParametricDraws(const ParametricValues& values)
    : isotropic_(values.isotropic()),
      padded_(values.padded_count()),
      nodes_(isotropic_, isotropic_ ? kRadiusCells : kSquareCells),
      rows_(static_cast<size_t>(nodes_.count() * kColumns * padded_)),
      proposals_(static_cast<size_t>(nodes_.count())),
      matter_(static_cast<size_t>(nodes_.count())) {
  parallel_fill(proposals_.size(), [&](size_t node) { fill_node(values, static_cast<int>(node)); });
}

void ParametricDraws::fill_node(const ParametricValues& values, int node) {
  WarpedMixture m;
  const Vec3 wv = nodes_.view(node);
  values.evaluate(wv, ViewPlace(wv), m);
  const std::vector<WarpedLobe> lobes = lobes_of(m);
  const uint32_t matter = lobes_that_matter(lobes, Vec3d(m.wv));
  matter_[static_cast<size_t>(node)] = matter;
  const DrawFit fit = fit_of(lobes, matter, Vec3d(m.wv));
  proposals_[static_cast<size_t>(node)] = few_lobes(fit);

  float* const row = rows_.data() + node * kColumns * padded_;
  const auto at = [&](int column, int lobe) -> float& { return row[column * padded_ + lobe]; };
  double up_to = kDefensiveShare + (1 - kDefensiveShare) * fit.cosine;
  auto below = static_cast<float>(up_to);
  for (int j = 0; j < padded_; ++j) {
    at(kBandwidthRatio, j) = 1;
    at(kBelow, j) = below;
    if (j < m.count) {
      const DrawnLobe& lobe = fit.lobes[static_cast<size_t>(j)];
      const Vec3 offset = Vec3(lobe.center) - Vec3(m.x[j], m.y[j], m.z[j]);
      at(kOffsetX, j) = offset.x;
      at(kOffsetY, j) = offset.y;
      at(kOffsetZ, j) = offset.z;
      at(kBandwidthRatio, j) = static_cast<float>(lobe.bandwidth) / m.bandwidth[j];
      up_to += (1 - kDefensiveShare) * lobe.probability;
    }
    at(kUpTo, j) = below = j + 1 < m.count ? static_cast<float>(std::min(up_to, 1.0)) : 1.0f;
  }
}

uint32_t ParametricDraws::matter_between(const ViewPlace& first, const ViewPlace& last) const {
  uint32_t matter = 0;
  for (int node = nodes_.at(first).node[0]; node <= nodes_.at(last).node[1]; ++node) {
    matter |= matter_[static_cast<size_t>(node)];
  }
  return matter;
}

void ParametricDraws::add_to(const ViewPlace& place, WarpedMixture& mixture) const {
  VELOUR_SIMD_DISPATCH(add_draws_simd)(rows_.data(), nodes_.at(place), mixture);
}

void ParametricDraws::propose(const WarpedMixture& mixture, ProposalLobes& lobes) const {
  const int node = nodes_.at(ViewPlace(mixture.wv)).nearest;
  lobes = proposals_[static_cast<size_t>(node)];
  const Mat3 align = rotation_between(mirror(nodes_.view(node)), mirror(mixture.wv));
  const float c = mixture.turn_cos, s = mixture.turn_sin;
  for (int j = 0; j < lobes.count; ++j) {
    const Vec3 center = align * lobes.lobe[j].center;
    lobes.lobe[j].center = {c * center.x - s * center.y, s * center.x + c * center.y, center.z};
  }
}

uint64_t ParametricDraws::bytes() const {
  return sizeof(float) * rows_.size() + sizeof(ProposalLobes) * proposals_.size() + sizeof(uint32_t) * matter_.size();
}

}  // namespace velour
#endif
