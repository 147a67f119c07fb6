#include "verdict/surroundings.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "verdict/surroundings.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// Requires Highway's namespace of the target.
#include "base/simd_dispatch.h"

#ifndef VELOUR_BRDF_VERDICT_SURROUNDINGS_LIT
#define VELOUR_BRDF_VERDICT_SURROUNDINGS_LIT
namespace velour {

/// A surface under lights. `count` is a whole number of vectors.
struct LitSurface {
  const Frame& frame;
  const Surroundings::Radiance* texels;
  const float *x, *y, *z, *first, *side;
  const std::array<float, 8>* reflected;
  size_t count;
};

}  // namespace velour
#endif

HWY_BEFORE_NAMESPACE();
namespace velour::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void Reflect(const LitSurface& lit, Surroundings::Radiance out[2]) {
  const hn::CappedTag<float, 16> tag;
  const hn::RebindToSigned<decltype(tag)> whole;
  const hn::CappedTag<float, 4> rgb;
  constexpr size_t kLanes = hn::MaxLanes(rgb), kNext = Surroundings::Radiance().size(), kVectors = kNext / kLanes;
  using V = hn::Vec<decltype(tag)>;
  const auto every = [tag](float value) { return hn::Set(tag, value); };
  const V zero = hn::Zero(tag), half = every(0.5f), one = every(1.0f), two = every(2.0f);
  hn::Vec<decltype(rgb)> sum[2][kVectors];
  for (auto& of_material : sum) {
    for (auto& s : of_material) s = hn::Zero(rgb);
  }
  const size_t lanes = hn::Lanes(tag);
  HWY_ALIGN int32_t texel[16];
  HWY_ALIGN int32_t below[16];
  HWY_ALIGN float right[16];
  HWY_ALIGN float down[16];
  for (size_t i = 0; i < lit.count; i += lanes) {
    const V x = hn::LoadU(tag, lit.x + i), y = hn::LoadU(tag, lit.y + i), z = hn::LoadU(tag, lit.z + i);
    const auto to_world = [&](int c) {
      const V xy = hn::MulAdd(x, every(lit.frame.x[c]), hn::Mul(y, every(lit.frame.y[c])));
      return hn::MulAdd(z, every(lit.frame.z[c]), xy);
    };
    const V wx = to_world(0), wy = to_world(1), wz = to_world(2);
    const V scale = hn::Div(one, hn::Add(hn::Abs(wx), hn::Add(hn::Abs(wy), hn::Abs(wz))));
    const V u = hn::Mul(wx, scale), v = hn::Mul(wy, scale);
    const auto is_below = hn::Lt(wz, zero);
    const V map_x = hn::IfThenElse(is_below, hn::CopySign(hn::Sub(one, hn::Abs(v)), u), u);
    const V map_y = hn::IfThenElse(is_below, hn::CopySign(hn::Sub(one, hn::Abs(u)), v), v);
    const V side = hn::LoadU(tag, lit.side + i);
    const auto texel_of = [&](V at) {
      const V centers = hn::Sub(hn::Mul(hn::MulAdd(half, at, half), side), half);
      return hn::Min(hn::Max(centers, zero), hn::Sub(side, one));
    };
    const V column = texel_of(map_x), row = texel_of(map_y);
    const V left = hn::Min(hn::Floor(column), hn::Sub(side, two)), top = hn::Min(hn::Floor(row), hn::Sub(side, two));
    hn::Store(hn::Sub(column, left), tag, right);
    hn::Store(hn::Sub(row, top), tag, down);
    hn::Store(hn::ConvertTo(whole, hn::Add(hn::LoadU(tag, lit.first + i), hn::MulAdd(top, side, left))), whole, texel);
    hn::Store(hn::ConvertTo(whole, side), whole, below);
    for (size_t k = 0; k < lanes; ++k) {
      const float* const upper = lit.texels[texel[k]].data();
      const float* const lower = lit.texels[texel[k] + below[k]].data();
      const auto along = hn::Set(rgb, right[k]), across = hn::Set(rgb, down[k]);
      const auto mix = [](auto from, auto to, auto share) { return hn::MulAdd(share, hn::Sub(to, from), from); };
      const float* const reflected = lit.reflected[i + k].data();
      for (size_t c = 0; c < kVectors; ++c) {
        const auto in_row = [&](const float* from) {
          return mix(hn::LoadU(rgb, from + c * kLanes), hn::LoadU(rgb, from + kNext + c * kLanes), along);
        };
        const auto radiance = mix(in_row(upper), in_row(lower), across);
        const float* const factor = reflected + c * kLanes % 4;
        sum[0][c] = hn::MulAdd(hn::LoadU(rgb, factor), radiance, sum[0][c]);
        sum[1][c] = hn::MulAdd(hn::LoadU(rgb, factor + 4), radiance, sum[1][c]);
      }
    }
  }
  for (size_t m = 0; m < 2; ++m) {
    for (size_t c = 0; c < kVectors; ++c) hn::StoreU(sum[m][c], rgb, out[m].data() + c * kLanes);
  }
}

}  // namespace velour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

namespace {

HWY_EXPORT(Reflect);

constexpr int kSide = 128, kSamples = 2;  // of the finest level; per texel and axis

float soft_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// 1 within a rectangle seen in the direction `center`, whose half sides are tangents of angles; soft borders.
float box(const Vec3& w, const Vec3& center, float half_width, float half_height) {
  constexpr float kSoft = 0.04f;
  const Vec3 z = glm::normalize(center), x = glm::normalize(glm::cross(Vec3(0, 1, 0), z)), y = glm::cross(z, x);
  const float depth = glm::dot(w, z);
  if (depth <= 0) return 0;
  const float u = std::abs(glm::dot(w, x)) / depth, v = std::abs(glm::dot(w, y)) / depth;
  return (1 - soft_step(half_width - kSoft, half_width + kSoft, u)) *
         (1 - soft_step(half_height - kSoft, half_height + kSoft, v));
}

/// 1 within `radius` radians of `center`, soft by a third of it.
float disk(const Vec3& w, const Vec3& center, float radius) {
  const float angle = std::acos(std::clamp(glm::dot(w, glm::normalize(center)), -1.0f, 1.0f));
  return 1 - soft_step(radius * 0.83f, radius * 1.17f, angle);
}

Rgb studio(const Vec3& w) {
  Rgb out = Rgb(0.06f) + Rgb(0.1f) * soft_step(-1, 1, w.y);
  out += Rgb(11, 10.5f, 10) * box(w, {-0.7f, 0.7f, 0.6f}, 0.45f, 0.45f);
  out += Rgb(1.6f, 1.7f, 1.9f) * box(w, {0.9f, 0.1f, 0.5f}, 0.8f, 1.0f);
  out += Rgb(9) * box(w, {0.5f, 0.35f, -0.8f}, 0.12f, 1.1f);
  out += Rgb(5) * box(w, {-0.9f, 0, -0.5f}, 0.1f, 0.8f);
  return out;
}

Rgb clear_sky(const Vec3& w) {
  const Rgb ground(0.22f, 0.18f, 0.14f), zenith(0.22f, 0.38f, 0.8f), horizon(0.75f, 0.8f, 0.9f);
  const Rgb sky = glm::mix(horizon, zenith, std::pow(std::max(w.y, 0.0f), 0.5f));
  const Vec3 sun(0.45f, 0.6f, 0.65f);
  const float about_sun = std::max(glm::dot(w, glm::normalize(sun)), 0.0f);
  return glm::mix(ground, sky, soft_step(-0.03f, 0.03f, w.y)) + Rgb(190, 175, 150) * disk(w, sun, 0.045f) +
         Rgb(1.2f, 1.1f, 1) * std::pow(about_sun, 24.0f);
}

Rgb street_at_night(const Vec3& w) {
  struct Lamp {
    Vec3 towards;
    float radius;
    Rgb color;
  };
  static constexpr std::array<Lamp, 8> kLamps{{{{-0.8f, 0.45f, 0.4f}, 0.10f, {30, 18, 8}},
                                               {{-0.3f, 0.3f, 0.9f}, 0.05f, {60, 40, 20}},
                                               {{0.5f, 0.55f, 0.6f}, 0.08f, {35, 22, 10}},
                                               {{0.95f, 0.2f, 0.1f}, 0.12f, {4, 14, 24}},
                                               {{0.2f, -0.25f, 0.9f}, 0.06f, {22, 3, 3}},
                                               {{-0.6f, -0.1f, -0.7f}, 0.12f, {20, 16, 12}},
                                               {{0.4f, 0.15f, -0.9f}, 0.09f, {8, 26, 10}},
                                               {{0.0f, 0.95f, -0.2f}, 0.16f, {7, 8, 11}}}};
  Rgb out = glm::mix(Rgb(0.05f, 0.045f, 0.04f), Rgb(0.03f, 0.05f, 0.12f), soft_step(-0.2f, 0.4f, w.y));
  out += Rgb(0.5f, 0.35f, 0.25f) * std::exp(-30 * w.y * w.y);  // lit walls about the horizon
  for (const Lamp& lamp : kLamps) out += lamp.color * disk(w, lamp.towards, lamp.radius);
  return out;
}

/// The direction of a point of the octahedral map, coordinates in [-1, 1].
Vec3 unfolded(float u, float v) {
  Vec3 w(u, v, 1 - std::abs(u) - std::abs(v));
  if (w.z < 0) w = {std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), w.z};
  return glm::normalize(w);
}

Surroundings::Radiance radiance(const Vec3& w) {
  const Rgb all[Surroundings::kCount]{studio(w), clear_sky(w), street_at_night(w)};
  Surroundings::Radiance out{};
  for (size_t e = 0; e < Surroundings::kCount; ++e) {
    for (size_t c = 0; c < 3; ++c) out[4 * e + c] = all[e][static_cast<int>(c)];
  }
  return out;
}

void add(Surroundings::Radiance& sum, const Surroundings::Radiance& value, float weight) {
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += weight * value[i];
}

Surroundings::Radiance texel_mean(int x, int y) {
  Surroundings::Radiance sum{};
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const auto at = [](int texel, int sample) {
      return 2 * (static_cast<float>(texel) + (static_cast<float>(sample) + 0.5f) / kSamples) / kSide - 1;
    };
    add(sum, radiance(unfolded(at(x, i % kSamples), at(y, i / kSamples))), 1.0f / (kSamples * kSamples));
  }
  return sum;
}

}  // namespace

Surroundings::Surroundings() {
  levels_.push_back({kSide, 0});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) texels_.push_back(texel_mean(x, y));
  }
  for (int side = kSide / 2; side >= 2; side /= 2) {
    const size_t finer = levels_.back().first, first = texels_.size();
    const auto at = [](int width, int x, int y) { return static_cast<size_t>(y * width + x); };
    levels_.push_back({side, first});
    texels_.resize(first + at(side, 0, side));
    for (int y = 0; y < 2 * side; ++y) {
      for (int x = 0; x < 2 * side; ++x) {
        add(texels_[first + at(side, x / 2, y / 2)], texels_[finer + at(2 * side, x, y)], 0.25f);
      }
    }
  }
}

const Surroundings::Level& Surroundings::level_of(double solid_angle) const {
  const double texels = solid_angle * kSide * kSide / (4 * kPiD);
  const auto level = std::lround(0.5 * std::log2(std::max(texels, 1e-9)));
  return levels_[static_cast<size_t>(std::clamp<long>(level, 0, static_cast<long>(levels_.size()) - 1))];
}

void Surroundings::Lights::add(const Surroundings& surroundings, const Vec3& wl, double solid_angle,
                               const std::array<Rgb, 2>& reflected) {
  if (count_ % kPadding == 0) {
    for (std::vector<float>* values : {&x_, &y_, &z_, &first_, &side_}) values->resize(count_ + kPadding, 2.0f);
    reflected_.resize(count_ + kPadding, {});
  }
  const Level& level = surroundings.level_of(solid_angle);
  x_[count_] = wl.x, y_[count_] = wl.y, z_[count_] = wl.z;
  first_[count_] = static_cast<float>(level.first), side_[count_] = static_cast<float>(level.side);
  for (size_t m = 0; m < 2; ++m) {
    for (int c = 0; c < 3; ++c) reflected_[count_][4 * m + static_cast<size_t>(c)] = reflected[m][c];
  }
  ++count_;
}

std::array<Surroundings::Radiance, 2> Surroundings::reflected(const Frame& surface, const Lights& lights) const {
  std::array<Radiance, 2> out;
  VELOUR_SIMD_DISPATCH(Reflect)
  ({surface, texels_.data(), lights.x_.data(), lights.y_.data(), lights.z_.data(), lights.first_.data(),
    lights.side_.data(), lights.reflected_.data(), lights.x_.size()},
   out.data());
  return out;
}

}  // namespace velour
#endif  // HWY_ONCE
