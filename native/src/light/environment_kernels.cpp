// Highway compiles this file once for each instruction set.
#include "light/environment_fit.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/environment_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// w - c and half its square, with the kernel exp(-bandwidth |w - c|^2 / 2).
template <class D, class V = hn::Vec<D>>
struct Offset {
  HWY_INLINE Offset(D d, V x, V y, V z, float cx, float cy, float cz)
      : dx(hn::Sub(x, hn::Set(d, cx))), dy(hn::Sub(y, hn::Set(d, cy))), dz(hn::Sub(z, hn::Set(d, cz))) {
    half_sq = hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
  }
  HWY_INLINE V kernel(D d, float bandwidth) const {
    return exp_nonpositive(d, hn::Mul(half_sq, hn::Set(d, -bandwidth)));
  }
  V dx, dy, dz, half_sq;
};

/// Cells of a block, padded with cells without energy.
struct alignas(64) Block {
  float x[kEnvironmentBlock], y[kEnvironmentBlock], z[kEnvironmentBlock], spread[kEnvironmentBlock],
      energy[kEnvironmentBlock], area[kEnvironmentBlock];
  float r[kEnvironmentBlock], g[kEnvironmentBlock], b[kEnvironmentBlock];
  float inverse[kEnvironmentBlock], chi[kEnvironmentBlock],
      excess[kEnvironmentBlock];  // 1 / density; see EnvironmentMoments
  int count;
};

void load(const EnvironmentPoints& p, size_t first, Block& block) {
  const size_t n = std::min(kEnvironmentBlock, p.size() - first);
  const auto copy = [&](const std::vector<float>& from, float* to) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(first), n, to);
    std::fill(to + n, to + kEnvironmentBlock, 0.0f);
  };
  copy(p.x, block.x);
  copy(p.y, block.y);
  copy(p.z, block.z);
  copy(p.spread, block.spread);
  copy(p.energy, block.energy);
  copy(p.solid_angle, block.area);
  copy(p.r, block.r);
  copy(p.g, block.g);
  copy(p.b, block.b);
  block.count = static_cast<int>(n);
}

template <class D>
void densities(D d, const EnvironmentLobes& lobes, Block& block, float* scratch) {
  for (size_t i = 0; i < kEnvironmentBlock; i += hn::Lanes(d)) {
    const auto x = hn::Load(d, block.x + i), y = hn::Load(d, block.y + i), z = hn::Load(d, block.z + i);
    auto total = hn::Set(d, 1e-30f);
    for (size_t k = 0; k < lobes.size(); ++k) {
      const Offset<D> o(d, x, y, z, lobes.x[k], lobes.y[k], lobes.z[k]);
      const auto value = hn::Mul(hn::Set(d, lobes.peak[k]), o.kernel(d, lobes.bandwidth[k]));
      hn::StoreU(value, d, scratch + k * kEnvironmentBlock + i);
      total = hn::Add(total, value);
    }
    const auto expected = hn::Max(hn::Mul(total, hn::Load(d, block.area + i)), hn::Set(d, 1e-30f));
    const auto excess = hn::Max(hn::Sub(hn::Load(d, block.energy + i), expected), hn::Zero(d));
    hn::Store(hn::Div(hn::Set(d, 1.0f), total), d, block.inverse + i);
    hn::Store(excess, d, block.excess + i);
    // A single texel that no lobe covers yet must not dominate the sums.
    const auto ratio = hn::Min(hn::Div(excess, expected), hn::Set(d, 1e12f));
    hn::Store(hn::Mul(excess, ratio), d, block.chi + i);
  }
}

template <class D>
EnvironmentMoments moments_of(D d, const EnvironmentLobes& lobes, size_t k, const Block& block, const float* values) {
  using V = hn::Vec<D>;
  const V zero = hn::Zero(d);
  V energy = zero, dx = zero, dy = zero, dz = zero, q = zero, r = zero, g = zero, b = zero;
  V chi = zero, chi_x = zero, chi_y = zero, chi_z = zero, chi_q = zero, excess = zero;
  for (size_t i = 0; i < kEnvironmentBlock; i += hn::Lanes(d)) {
    const Offset<D> o(d, hn::Load(d, block.x + i), hn::Load(d, block.y + i), hn::Load(d, block.z + i), lobes.x[k],
                      lobes.y[k], lobes.z[k]);
    const V p = hn::Mul(hn::LoadU(d, values + i), hn::Load(d, block.inverse + i));
    const V half_sq = hn::Add(o.half_sq, hn::Load(d, block.spread + i));
    const V e = hn::Mul(p, hn::Load(d, block.energy + i)), c = hn::Mul(p, hn::Load(d, block.chi + i));
    energy = hn::Add(energy, e);
    dx = hn::MulAdd(e, o.dx, dx);
    dy = hn::MulAdd(e, o.dy, dy);
    dz = hn::MulAdd(e, o.dz, dz);
    q = hn::MulAdd(e, half_sq, q);
    r = hn::MulAdd(p, hn::Load(d, block.r + i), r);
    g = hn::MulAdd(p, hn::Load(d, block.g + i), g);
    b = hn::MulAdd(p, hn::Load(d, block.b + i), b);
    chi = hn::Add(chi, c);
    chi_x = hn::MulAdd(c, o.dx, chi_x);
    chi_y = hn::MulAdd(c, o.dy, chi_y);
    chi_z = hn::MulAdd(c, o.dz, chi_z);
    chi_q = hn::MulAdd(c, half_sq, chi_q);
    excess = hn::MulAdd(p, hn::Load(d, block.excess + i), excess);
  }
  const auto sum = [d](V v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); };
  return {sum(energy), sum(dx),  sum(dy),    sum(dz),    sum(q),     sum(r),     sum(g),
          sum(b),      sum(chi), sum(chi_x), sum(chi_y), sum(chi_z), sum(chi_q), sum(excess)};
}

void add_block_simd(const EnvironmentPoints& points, size_t first, const EnvironmentLobes& lobes, float* scratch,
                    EnvironmentMoments* moments) {
  const hn::CappedTag<float, 16> d;
  Block block;
  load(points, first, block);
  densities(d, lobes, block, scratch);
  for (size_t k = 0; k < lobes.size(); ++k)
    moments[k] += moments_of(d, lobes, k, block, scratch + k * kEnvironmentBlock);
}

double smoothed_simd(const EnvironmentPoints& p, const Vec3& w, float bandwidth) {
  const hn::CappedTag<float, 16> d;
  const size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, 1.0f);
  double total = 0;
  size_t i = 0;
  for (; i + lanes <= p.size(); i += lanes) {
    const Offset<decltype(d)> o(d, hn::LoadU(d, &p.x[i]), hn::LoadU(d, &p.y[i]), hn::LoadU(d, &p.z[i]), w.x, w.y, w.z);
    const auto widened = hn::Div(one, hn::MulAdd(hn::LoadU(d, &p.spread[i]), hn::Set(d, bandwidth), one));
    const auto kernel = exp_nonpositive(d, hn::Mul(hn::Mul(o.half_sq, hn::Set(d, -bandwidth)), widened));
    const auto value = hn::Mul(hn::Mul(hn::LoadU(d, &p.energy[i]), widened), kernel);
    total += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, value)));
  }
  for (; i < p.size(); ++i) {
    const Vec3 diff = p.direction(i) - w;
    const float widened = 1.0f / (1.0f + p.spread[i] * bandwidth);
    total += static_cast<double>(p.energy[i] * widened * std::exp(-0.5f * bandwidth * widened * glm::dot(diff, diff)));
  }
  return total;
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(add_block_simd);
HWY_EXPORT(smoothed_simd);

EnvironmentMoments& EnvironmentMoments::operator+=(const EnvironmentMoments& o) {
  energy += o.energy;
  dx += o.dx;
  dy += o.dy;
  dz += o.dz;
  q += o.q;
  r += o.r;
  g += o.g;
  b += o.b;
  chi += o.chi;
  chi_x += o.chi_x;
  chi_y += o.chi_y;
  chi_z += o.chi_z;
  chi_q += o.chi_q;
  excess += o.excess;
  return *this;
}

void add_environment_block(const EnvironmentPoints& points, size_t first, const EnvironmentLobes& lobes, float* scratch,
                           EnvironmentMoments* moments) {
  VELOUR_SIMD_DISPATCH(add_block_simd)(points, first, lobes, scratch, moments);
}

double smoothed_environment(const EnvironmentPoints& points, const Vec3& w, float bandwidth) {
  return VELOUR_SIMD_DISPATCH(smoothed_simd)(points, w, bandwidth);
}

}  // namespace velour
#endif
