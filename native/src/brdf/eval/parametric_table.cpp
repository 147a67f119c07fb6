// Highway compiles this file once for each instruction set.
#include "brdf/eval/parametric_table.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/eval/parametric_table.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/srbf/draw_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The padded number of lobes is a template argument so that every address offset is a constant.
template <int kPadded>
HWY_INLINE void mix_rows(const TableRows& rows, const ViewTapsOf<float>& taps, WarpedMixture& m) {
  using T = ParametricTable;
  const hn::CappedTag < float, kPadded<16 ? kPadded : 16> d;
  using V = hn::Vec<decltype(d)>;
  const auto weights = [&](const float* w) { return Vector<V>{hn::Set(d, w[0]), hn::Set(d, w[1]), hn::Set(d, w[2])}; };
  const Vector<V> even = weights(taps.weight), odd = weights(taps.odd_weight);
  const auto row = [&](int i) { return rows.control + taps.node[i] * T::kColumns * kPadded; };
  const float *const a = row(0), *const b = row(1), *const c = row(2);
  for (int at = 0; at < kPadded; at += static_cast<int>(hn::Lanes(d))) {
    const auto sum = [&](int which, const Vector<V>& w) {
      const int from = which * kPadded + at;
      const V first = hn::Mul(w.x, hn::Load(d, a + from));
      return hn::MulAdd(w.z, hn::Load(d, c + from), hn::MulAdd(w.y, hn::Load(d, b + from), first));
    };
    const auto column = [&](int which) { return sum(which, even); };
    const V zero = hn::Zero(d);
    hn::Store(hn::LoadU(d, rows.half + at), d, m.half + at);
    hn::Store(column(T::kSxx), d, m.s_xx + at);
    hn::Store(zero, d, m.s_xy + at);
    hn::Store(column(T::kSyy), d, m.s_yy + at);
    hn::Store(sum(T::kX, odd), d, m.x + at);
    hn::Store(zero, d, m.y + at);
    hn::Store(column(T::kZ), d, m.z + at);
    hn::Store(column(T::kBandwidth), d, m.bandwidth + at);
    hn::Store(column(T::kRed), d, m.r + at);
    hn::Store(column(T::kGreen), d, m.g + at);
    hn::Store(column(T::kBlue), d, m.b + at);
  }
}

/// Avoids the latency of a division. Away from the normal 1 - z loses no precision.
void evaluate_simd(const TableRows& rows, const Vec3& wv, WarpedMixture& m) {
  const hn::CappedTag<float, 1> one;
  const float z = std::max(wv.z, 0.0f), sine_sq = std::max(wv.x * wv.x + wv.y * wv.y, 1e-30f);
  const float inverse = hn::GetLane(reciprocal_sqrt(one, hn::Set(one, sine_sq)));
  m.turn_cos = inverse * wv.x;
  m.turn_sin = inverse * wv.y;
  m.wv = Vec3(inverse * sine_sq, 0, wv.z);
  ViewTapsOf<float> taps = rows.spline.at(PolarView<float>{polar_angle(std::sqrt(1 - z), z), m.turn_cos, m.turn_sin});
  while (taps.count < SplineRows::kIsotropicTaps) taps.add(0, 0, 0);  // fewer taps next to the normal
  const LobeList& list = rows.lists[taps.node[0]];
  m.listed = list.lobe;
  m.listed_count = list.count;
  if (m.padded == 8) return mix_rows<8>(rows, taps, m);
  if (m.padded == 16) return mix_rows<16>(rows, taps, m);
  return mix_rows<32>(rows, taps, m);
}
static_assert(WarpedMixture::kCapacity == 32);

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

namespace velour {

HWY_EXPORT(evaluate_simd);

namespace {

constexpr double kFadeEnd = 0.2;  // radians; beyond it the stretch fade is 1 in float
constexpr int kIntervals = 320;   // minimum of the table

Vec3 view_of(double theta) { return Vec3(Vec3d(std::sin(theta), 0, std::max(std::cos(theta), 0.0))); }

/// Source of a table column.
struct Source {
  ParametricTable::Column column;
  float (WarpedMixture::*array)[WarpedMixture::kCapacity];
  bool odd = false;
};
using T = ParametricTable;
using M = WarpedMixture;
constexpr Source kValues[] = {
    {T::kX, &M::x, true}, {T::kZ, &M::z},     {T::kSxx, &M::s_xx}, {T::kSyy, &M::s_yy},
    {T::kRed, &M::r},     {T::kGreen, &M::g}, {T::kBlue, &M::b},   {T::kBandwidth, &M::bandwidth}};

}  // namespace

ParametricTable::ParametricTable(const ParametricValues& values, const ParametricNodes& nodes)
    : count_(values.count()), padded_(values.padded_count()), most_z_(-1), spline_(values.spline()) {
  if (!values.isotropic()) return;
  half_ = values.half();
  most_z_ = static_cast<float>(std::cos(kFadeEnd));
  spline_ = spline_.refined((kIntervals + spline_.cells() - 1) / spline_.cells());
  fill(values);
  leave_out_idle(nodes);
}

void ParametricTable::fill(const ParametricValues& values) {
  const auto sites = spline_.sites();
  std::vector<WarpedMixture> mixtures(sites.size());
  for (size_t i = 0; i < sites.size(); ++i) {
    const Vec3 wv = view_of(sites[i]);
    values.evaluate(wv, ViewPlace(wv), mixtures[i]);
  }
  rows_.assign(sites.size() * kColumns * static_cast<size_t>(padded_), 0.0f);
  std::vector<double> control(sites.size());
  for (int j = 0; j < padded_; ++j) {
    for (const auto& [column, array, odd] : kValues) {
      for (size_t i = 0; i < sites.size(); ++i) control[i] = static_cast<double>((mixtures[i].*array)[j]);
      const double least = column == kX || column == kZ ? -1 : *std::min_element(control.begin(), control.end()) / 2;
      spline_.interpolate(control, odd);
      // The interpolation may overshoot below 0 where coefficients fall steeply.
      for (size_t i = 0; i < sites.size(); ++i) at(i, column, j) = static_cast<float>(std::max(control[i], least));
    }
  }
}

void ParametricTable::leave_out_idle(const ParametricNodes& nodes) {
  const auto sites = spline_.sites();
  const double step = sites[2] - sites[1];
  const auto place = [](double theta) { return ViewPlace(view_of(std::clamp(theta, 0.0, kPiD / 2))); };
  std::vector<uint32_t> matter;
  for (const double site : sites) {
    // Next to the normal, where the table ends, keep all lobes, as the model does beyond.
    const bool at_the_end = site < kFadeEnd + 2 * step;
    matter.push_back(at_the_end ? ~0u : nodes.matter_between(place(site - 1.5 * step), place(site + 1.5 * step)));
  }
  for (size_t i = 0; i < sites.size(); ++i) {
    for (int j = 0; j < count_; ++j) {
      if ((matter[i] >> j & 1) == 0) at(i, kRed, j) = at(i, kGreen, j) = at(i, kBlue, j) = 0;
    }
  }
  for (size_t i = 0; i + 2 < sites.size(); ++i) {
    LobeList& list = lists_.emplace_back();
    for (int j = 0; j < count_; ++j) {
      if (((matter[i] | matter[i + 1] | matter[i + 2]) >> j & 1) != 0)
        list.lobe[list.count++] = static_cast<uint8_t>(j);
    }
  }
}

void ParametricTable::evaluate(const Vec3& wv, WarpedMixture& mixture) const {
  mixture.count = count_;
  mixture.padded = padded_;
  VELOUR_SIMD_DISPATCH(evaluate_simd)({half_.data(), rows_.data(), lists_.data(), spline_}, wv, mixture);
}

}  // namespace velour
#endif
