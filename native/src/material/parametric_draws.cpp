// Highway compiles this file once for each instruction set.
#include "material/parametric_draws.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/parametric_draws.cpp"
#include <hwy/foreach_target.h>

// Only after that one:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"
#include "srbf/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void draws_simd(const float* table, const NodeWeights& nodes, WarpedMixture& m) {
  using P = ParametricDraws;
  const hn::CappedTag<float, WarpedMixture::kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const int row = P::kColumns * m.padded;
  for (int at = 0; at < m.padded; at += static_cast<int>(hn::Lanes(d))) {
    const auto column = [&](int which) {
      V sum = hn::Zero(d);
      for (int i = 0; i < nodes.count; ++i) {
        const float* values = table + nodes.node[i] * row + which * m.padded + at;
        sum = hn::MulAdd(hn::Set(d, nodes.weight[i]), hn::LoadU(d, values), sum);
      }
      return sum;
    };
    const V x = hn::Add(hn::Load(d, m.x + at), column(P::kOffsetX));
    const V y = hn::Add(hn::Load(d, m.y + at), column(P::kOffsetY));
    const V z = hn::Add(hn::Load(d, m.z + at), column(P::kOffsetZ));
    const V scale = reciprocal_sqrt(d, hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
    hn::Store(hn::Mul(scale, x), d, m.draw_x + at);
    hn::Store(hn::Mul(scale, y), d, m.draw_y + at);
    hn::Store(hn::Mul(scale, z), d, m.draw_z + at);
    const V bandwidth = hn::Max(hn::Mul(hn::Load(d, m.bandwidth + at), column(P::kBandwidthRatio)), hn::Set(d, 1e-2f));
    hn::Store(bandwidth, d, m.draw_bandwidth + at);
    // The same sums, rounded the same way, as the numbers that choose: this is the probability of the draws.
    const V below = column(P::kBelow), up_to = column(P::kUpTo), probability = hn::Sub(up_to, below);
    hn::StoreU(up_to, d, m.cdf + 1 + at);
    if (at == 0) m.cdf[0] = hn::GetLane(below);
    const V whole = hn::Mul(hn::Set(d, -2 * kPi), hn::Expm1(d, hn::Mul(hn::Set(d, -2.0f), bandwidth)));
    hn::Store(hn::Div(hn::Mul(probability, bandwidth), whole), d, m.density + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

#include "material/drawn_lobe.h"
#include "sphere/frame.h"
#include "srbf/lobe_tree.h"

namespace velour {

HWY_EXPORT(draws_simd);

namespace {

constexpr double kDefensiveShare = 0.05;  // method 6.2
constexpr int kRadiusCells = 64, kSquareCells = 24;

/// A lobe of the mixture, as scalar code has it.
WarpedLobe lobe_of(const WarpedMixture& m, int j) {
  return {m.half[j] > 0 ? LobeSpace::half : LobeSpace::light,
          {m.s_xx[j], m.s_xy[j], m.s_yy[j]},
          glm::normalize(Vec3d(m.x[j], m.y[j], m.z[j])),
          m.bandwidth[j],
          {m.r[j], m.g[j], m.b[j]}};
}

std::vector<DrawnLobe> drawn_lobes(const WarpedMixture& m) {
  std::vector<DrawnLobe> lobes;
  for (int j = 0; j < m.count; ++j) lobes.push_back(drawn_lobe(lobe_of(m, j), Vec3d(m.wv)));
  return lobes;
}

ProposalLobes few_lobes(const std::vector<DrawnLobe>& drawn) {
  GaussianLobes lobes;
  ProposalLobes few;
  for (const DrawnLobe& lobe : drawn) {
    if (lobe.is_cosine) {
      few.cosine += static_cast<float>(lobe.mass / kPiD);
    } else {
      const double amplitude = lobe.mass / kernel_integral(Kernel::gaussian, lobe.light_bandwidth);
      lobes.add({Vec3(lobe.light_center), static_cast<float>(lobe.light_bandwidth), static_cast<float>(amplitude)});
    }
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
      nodes_(isotropic_, isotropic_ ? kRadiusCells : kSquareCells) {
  for (int node = 0; node < nodes_.count(); ++node) add_node(values, node);
}

void ParametricDraws::add_node(const ParametricValues& values, int node) {
  WarpedMixture m;
  values.evaluate(nodes_.view(node), m);
  const std::vector<DrawnLobe> drawn = drawn_lobes(m);
  double total = 0, cosine = 0;
  for (const DrawnLobe& lobe : drawn) {
    total += lobe.mass;
    cosine += lobe.is_cosine ? lobe.mass : 0.0;
  }
  const auto probability = [&](double mass) { return total > 0 ? (1 - kDefensiveShare) * mass / total : 0.0; };
  double up_to = total > 0 ? kDefensiveShare + probability(cosine) : 1.0;
  auto below = static_cast<float>(up_to);

  std::vector<float> row(static_cast<size_t>(kColumns * padded_));
  const auto at = [&](int column, int lobe) -> float& { return row[static_cast<size_t>(column * padded_ + lobe)]; };
  for (int j = 0; j < padded_; ++j) {
    at(kBandwidthRatio, j) = 1;
    at(kBelow, j) = below;
    if (j < m.count) {
      const DrawnLobe& lobe = drawn[static_cast<size_t>(j)];
      const Vec3 offset = Vec3(lobe.center) - Vec3(m.x[j], m.y[j], m.z[j]);
      at(kOffsetX, j) = offset.x;
      at(kOffsetY, j) = offset.y;
      at(kOffsetZ, j) = offset.z;
      at(kBandwidthRatio, j) = static_cast<float>(lobe.bandwidth) / m.bandwidth[j];
      up_to += lobe.is_cosine ? 0.0 : probability(lobe.mass);
    }
    at(kUpTo, j) = below = j + 1 < m.count ? static_cast<float>(std::min(up_to, 1.0)) : 1.0f;
  }
  rows_.insert(rows_.end(), row.begin(), row.end());
  proposals_.push_back(few_lobes(drawn));
}

void ParametricDraws::add_to(WarpedMixture& mixture) const {
  VELOUR_SIMD_DISPATCH(draws_simd)(rows_.data(), nodes_.at(mixture.wv), mixture);
}

void ParametricDraws::propose(const WarpedMixture& mixture, ProposalLobes& lobes) const {
  const int node = nodes_.at(mixture.wv).nearest;
  lobes = proposals_[static_cast<size_t>(node)];
  const Mat3 align = rotation_between(mirror(nodes_.view(node)), mirror(mixture.wv));
  const float c = mixture.turn_cos, s = mixture.turn_sin;
  for (int j = 0; j < lobes.count; ++j) {
    const Vec3 center = align * lobes.lobe[j].center;
    lobes.lobe[j].center = {c * center.x - s * center.y, s * center.x + c * center.y, center.z};
  }
}

uint64_t ParametricDraws::bytes() const {
  return sizeof(float) * rows_.size() + sizeof(ProposalLobes) * proposals_.size();
}

}  // namespace velour
#endif
