// Products of spherical Gaussians of the light, the view and the half vector: the lobes of BTFs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// g(wl, wv) = G(wl) G(wv) G(h) with G(w) = exp(bandwidth (w . center - 1)) and h the half vector: a multivariate SRBF
/// with three arguments [T11]. Exponents add, so it takes one exponential. Each vector is center times bandwidth; a
/// zero vector leaves its argument out. Values in (0, 1].
struct MultivariateLobe {
  Vec3 light{0.0f}, view{0.0f}, half{0.0f};
};

struct LobesAt;

/// The unit half vector; the normal where wl = -wv leaves it undefined.
Vec3 half_vector(const DirectionPair& pair);

/// The arguments of a lobe.
struct LobeArguments {
  explicit LobeArguments(const DirectionPair& pair) : wl(pair.wl), wv(pair.wv), half(half_vector(pair)) {}
  /// In a frame that `turn` leads to.
  LobeArguments turned(const Mat3& turn) const {
    LobeArguments at = *this;
    at.wl = turn * wl;
    at.wv = turn * wv;
    at.half = turn * half;
    return at;
  }
  Vec3 wl, wv, half;
};

/// Lobes in the order they are given, as arrays that are padded to whole vectors by lobes of value 0. Immutable.
class MultivariateLobes {
 public:
  static constexpr uint32_t kPadding = 16;

  explicit MultivariateLobes(std::span<const MultivariateLobe> lobes);

  uint32_t size() const { return size_; }
  uint32_t padded() const { return padded_; }

  /// Of every lobe, padding included; `values` of padded() floats, aligned to 64 bytes.
  void values(const LobeArguments& at, float* values) const;

 private:
  friend Vec3 lobe_sums(const std::array<LobesAt, 2>& lobes, const std::array<const float*, 3>& coefficient);

  uint32_t size_, padded_;
  std::vector<float> exponent_;  // [10][padded]: components of light, view, half and the constant, for powers of 2
};

/// Lobes and what they are evaluated at.
struct LobesAt {
  const MultivariateLobes* lobes;
  LobeArguments at;
};

/// For each of three arrays of coefficients - of the first lobes' padded() ones, then of the second's; aligned to 64
/// bytes -, the sum of coefficient times value.
Vec3 lobe_sums(const std::array<LobesAt, 2>& lobes, const std::array<const float*, 3>& coefficient);

}  // namespace velour
