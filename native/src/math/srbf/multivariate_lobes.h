// Products of spherical Gaussians of the light, the view, the half vector and the phase angle: the lobes of BTFs.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "base/memory.h"
#include "math/sphere/vec.h"

namespace velour {

/// g(wl, wv) = G(wl) G(wv) G(h) P(wl . wv) with G(w) = exp(bandwidth (w . center - 1)) and h the half vector, a
/// multivariate SRBF with three arguments [T11]. P(c) = exp(phase c - |phase|) models the opposition effect [H86]: with
/// the light behind the viewer, shadows hide behind their casters. Exponents add, so a lobe takes one exponential. Each
/// vector is center times bandwidth; a zero vector omits its argument. Values in (0, 1].
struct MultivariateLobe {
  Vec3 light{0.0f}, view{0.0f}, half{0.0f};
  float phase = 0;

  /// The lobe as numbers: the components of the vectors, then the phase.
  static constexpr int kNumbers = 10;
  float& operator[](int i) { return i == 9 ? phase : (i < 3 ? light : i < 6 ? view : half)[i % 3]; }
  float operator[](int i) const { return const_cast<MultivariateLobe&>(*this)[i]; }
  /// Number i belongs to argument i / 3; length() is the bandwidth of an argument.
  static constexpr int kArguments = 4;
  float length(int argument) const {
    return argument == 3 ? std::abs(phase) : glm::length(argument == 0 ? light : argument == 1 ? view : half);
  }
};

struct ColoredLobes;

/// The unit half vector; the normal where wl = -wv leaves it undefined.
inline Vec3 half_vector(const DirectionPair& pair) {
  const Vec3 sum = pair.wl + pair.wv;
  const float length_sq = glm::dot(sum, sum);
  return length_sq > 1e-12f ? sum / std::sqrt(length_sq) : Vec3(0, 0, 1);
}

/// The arguments of a lobe.
struct LobeArguments {
  explicit LobeArguments(const DirectionPair& pair)
      : wl(pair.wl), wv(pair.wv), half(half_vector(pair)), phase(glm::dot(pair.wl, pair.wv)) {}
  /// The component that number i of a lobe multiplies.
  float operator[](int i) const { return i == 9 ? phase : (i < 3 ? wl : i < 6 ? wv : half)[i % 3]; }
  /// The arguments in the frame that `turn` maps to.
  LobeArguments turned(const Mat3& turn) const {
    LobeArguments at = *this;
    at.wl = turn * wl;
    at.wv = turn * wv;
    at.half = turn * half;
    return at;
  }
  Vec3 wl, wv, half;
  float phase;  // cosine of the angle between both, in any frame
};

/// Lobes in the given order, as arrays padded to whole vectors with lobes of value 0. Immutable.
class MultivariateLobes {
 public:
  static constexpr uint32_t kPadding = 16;

  explicit MultivariateLobes(std::span<const MultivariateLobe> lobes);

  uint32_t size() const { return size_; }
  uint32_t padded() const { return padded_; }

  /// Writes the value of every lobe, including padding, to `values`: padded() floats, aligned to 64 bytes.
  void values(const LobeArguments& at, float* values) const;

 private:
  friend Vec3 lobe_sums(const ColoredLobes& lobes, const DirectionPair& pair, const Mat3& turn,
                        const float* coefficient);

  uint32_t size_, padded_;
  // [block of 16][11][16]: numbers of the lobes and the constant term, scaled for powers of 2.
  AlignedArray<float> exponent_;
};

/// Lobes in the frame of their arguments, followed by lobes in a rotated frame.
struct ColoredLobes {
  const MultivariateLobes &lobes, &turned;
  const float* color;  // of both, with padding: [block of 16][3][16], aligned to 64 bytes
};

/// Sum of coefficient times color times value. `turn` maps to the rotated frame; `coefficient` has a value per lobe,
/// including padding, and is aligned to 64 bytes. Run-time dispatched SIMD.
Vec3 lobe_sums(const ColoredLobes& lobes, const DirectionPair& pair, const Mat3& turn, const float* coefficient);

}  // namespace velour
