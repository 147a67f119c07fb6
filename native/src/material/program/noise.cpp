// Blender's Noise, Wave and White Noise textures (kernel/svm/noise.h, fractal_noise.h, noisetex.h, wave.h of Cycles):
// Perlin's gradient noise [Per02] summed to fractals [EMP03, Ch. 16]. Highway compiles this file once for each
// instruction set.
#include "material/program/operands.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/program/noise.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "material/program/hash_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

HWY_INLINE Lanes faded(Lanes t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

/// Dot product of the offset from a corner of the lattice with the gradient that its hash selects.
HWY_INLINE Lanes gradient(Bits hash, const LanesPoint<1>& p) {
  return flipped(number_of((hash & Bits(7u)) + Bits(1u)), hash, 3) * p[0];
}
HWY_INLINE Lanes gradient(Bits hash, const LanesPoint<2>& p) {
  const LanesMask low = is_below(hash & Bits(7u), 4);
  const Lanes u = select(low, p[0], p[1]), v = 2.0f * select(low, p[1], p[0]);
  return flipped(u, hash, 0) + flipped(v, hash, 1);
}
HWY_INLINE Lanes gradient(Bits hash, const LanesPoint<3>& p) {
  const Bits h = hash & Bits(15u);
  const Lanes u = select(is_below(h, 8), p[0], p[1]);
  const Lanes high = select(is_equal(h & Bits(13u), 12), p[0], p[2]);  // 12 and 14
  const Lanes v = select(is_below(h, 4), p[1], high);
  return flipped(u, h, 0) + flipped(v, h, 1);
}
HWY_INLINE Lanes gradient(Bits hash, const LanesPoint<4>& p) {
  const Bits h = hash & Bits(31u);
  const Lanes u = select(is_below(h, 24), p[0], p[1]), v = select(is_below(h, 16), p[1], p[2]);
  const Lanes s = select(is_below(h, 8), p[2], p[3]);
  return flipped(u, h, 0) + flipped(v, h, 1) + flipped(s, h, 2);
}

/// The cell of a lattice around a point: along each axis, its near and its far corner, the offset from the near one,
/// and the weight of the far one.
template <int N>
struct LatticeCell {
  Bits near[N], far[N];
  LanesPoint<N> offset, weight;
};

template <int N>
HWY_INLINE Bits corner_hash(const LatticeCell<N>& cell, int corner) {
  const auto at = [&](int axis) { return (corner >> axis & 1) != 0 ? cell.far[axis] : cell.near[axis]; };
  if constexpr (N == 1) return hash_of(at(0));
  if constexpr (N == 2) return hash_of(at(0), at(1));
  if constexpr (N == 3) return hash_of(at(0), at(1), at(2));
  if constexpr (N == 4) return hash_of(at(0), at(1), at(2), at(3));
}

/// Interpolates along axes 0 to kAxis. Bits of `corner`: whether it is the far one along the other axes.
template <int N, int kAxis>
HWY_INLINE Lanes interpolated(const LatticeCell<N>& cell, int corner) {
  if constexpr (kAxis < 0) {
    LanesPoint<N> offset = cell.offset;
    for (int i = 0; i < N; ++i) {
      if ((corner >> i & 1) != 0) offset.v[i] = offset[i] - 1.0f;
    }
    return gradient(corner_hash(cell, corner), offset);
  } else {
    return lerped(interpolated<N, kAxis - 1>(cell, corner), interpolated<N, kAxis - 1>(cell, corner | 1 << kAxis),
                  cell.weight[kAxis]);
  }
}

/// Coordinates far from the origin, where floats are sparse, repeat every 100000 and avoid the corners of the lattice.
HWY_INLINE Lanes kept_precise(Lanes x) {
  const Lanes size = magnitude(x), repeated = x - 100000.0f * floor_of(size * 1e-5f) * select(x < 0.0f, -1.0f, 1.0f);
  return select(size < 100000.0f, x, repeated + select(size < 1000000.0f, 0.0f, 0.5f));
}

/// Gradient noise in about [-1, 1]. A function of its own: inlined in every fractal it would take a minute to compile.
template <int N>
HWY_NOINLINE Lanes noise_at(const LanesPoint<N>& place) {
  constexpr float kScale[] = {0.25f, 0.6616f, 0.982f, 0.8344f};
  LatticeCell<N> cell{{}, {}, place, place};
  for (int i = 0; i < N; ++i) {
    const Lanes x = kept_precise(place[i]), whole = floor_of(x);
    cell.near[i] = integer_of(whole);
    cell.far[i] = cell.near[i] + Bits(1u);
    cell.offset.v[i] = x - whole;
    cell.weight.v[i] = faded(cell.offset[i]);
  }
  return kScale[N - 1] * interpolated<N, N - 1>(cell, 0);
}

// Fractals: sums or products of octaves.

struct Fractal {
  NoiseKind kind;
  bool normalizes;
  Lanes octaves, roughness, lacunarity, offset, gain;

  HWY_INLINE Lanes whole() const { return floor_of(octaves); }
  HWY_INLINE Lanes rest() const { return octaves - floor_of(octaves); }
};

template <int N>
HWY_NOINLINE Lanes fbm(LanesPoint<N> p, const Fractal& f) {
  const Lanes whole = f.whole(), rest = f.rest();
  Lanes sum = 0.0f, amplitude = 1.0f, total = 0.0f, scale = 1.0f;
  for (int i = 0;; ++i) {
    const LanesMask within = Lanes(static_cast<float>(i)) < whole;
    const LanesMask partly = excluding(Lanes(static_cast<float>(i)) < f.octaves, within);
    if (!any(either(within, partly))) break;
    const Lanes part = select(within, 1.0f, select(partly, rest, 0.0f));
    const Lanes term = noise_at(p * scale) * amplitude;
    // A last octave that counts partly mixes the normalized sums with and without it.
    const Lanes with = select(partly, lerped(sum / total, (sum + term) / (total + amplitude), part), 0.0f);
    if (f.normalizes) {
      sum = select(partly, with, sum + part * term);
      total = select(partly, 1.0f, total + select(within, amplitude, 0.0f));
    } else {
      sum = sum + part * term;
    }
    amplitude = select(within, amplitude * f.roughness, amplitude);
    scale = select(within, scale * f.lacunarity, scale);
  }
  return f.normalizes ? 0.5f * sum / total + 0.5f : sum;
}

template <int N>
HWY_NOINLINE Lanes multifractal(LanesPoint<N> p, const Fractal& f) {
  const Lanes whole = f.whole(), rest = f.rest();
  Lanes value = 1.0f, power = 1.0f;
  for (int i = 0;; ++i) {
    const Lanes at(static_cast<float>(i));
    if (!any(at < f.octaves)) break;
    const Lanes part = select(at < whole, 1.0f, select(at < f.octaves, rest, 0.0f));
    value = value * (part * power * noise_at(p) + 1.0f);
    power = power * f.roughness;
    p = p * f.lacunarity;
  }
  return value;
}

template <int N>
HWY_NOINLINE Lanes hetero_terrain(LanesPoint<N> p, const Fractal& f) {
  const Lanes whole = larger(f.whole(), 1.0f), rest = f.rest();
  Lanes value = f.offset + noise_at(p), power = f.roughness;
  p = p * f.lacunarity;
  for (int i = 1;; ++i) {
    const Lanes at(static_cast<float>(i));
    const LanesMask within = at < whole, partly = excluding(at < whole + select(rest != 0.0f, 1.0f, 0.0f), within);
    if (!any(either(within, partly))) break;
    const Lanes part = select(within, 1.0f, select(partly, rest, 0.0f));
    value = value + part * ((noise_at(p) + f.offset) * power * value);
    power = power * f.roughness;
    p = p * f.lacunarity;
  }
  return value;
}

template <int N>
HWY_NOINLINE Lanes hybrid_multifractal(LanesPoint<N> p, const Fractal& f) {
  const Lanes whole = f.whole(), rest = f.rest();
  Lanes value = 0.0f, power = 1.0f, weight = 1.0f;
  for (int i = 0;; ++i) {
    const Lanes at(static_cast<float>(i));
    const LanesMask counts = both(at < f.octaves, Lanes(0.001f) < weight);
    if (!any(counts)) break;
    const Lanes part = select(at < whole, 1.0f, rest), limited = smaller(weight, 1.0f);
    const Lanes signal = (noise_at(p) + f.offset) * power;
    value = value + select(counts, part * limited * signal, 0.0f);
    weight = select(counts, limited * f.gain * signal, 0.0f);
    power = power * f.roughness;
    p = p * f.lacunarity;
  }
  return value;
}

template <int N>
HWY_NOINLINE Lanes ridged_multifractal(LanesPoint<N> p, const Fractal& f) {
  const auto ridge = [&] {
    const Lanes height = f.offset - magnitude(noise_at(p));
    return height * height;
  };
  const Lanes whole = f.whole();
  Lanes signal = ridge(), value = signal, power = f.roughness;
  for (int i = 1;; ++i) {
    const LanesMask counts = Lanes(static_cast<float>(i)) < whole;
    if (!any(counts)) break;
    p = p * f.lacunarity;
    signal = smaller(larger(signal * f.gain, 0.0f), 1.0f) * ridge();
    value = value + select(counts, signal * power, 0.0f);
    power = power * f.roughness;
  }
  return value;
}

template <int N>
HWY_INLINE Lanes fractal_at(const LanesPoint<N>& p, const Fractal& f) {
  switch (f.kind) {
    case NoiseKind::fbm:
      return fbm(p, f);
    case NoiseKind::multifractal:
      return multifractal(p, f);
    case NoiseKind::hybrid_multifractal:
      return hybrid_multifractal(p, f);
    case NoiseKind::ridged_multifractal:
      return ridged_multifractal(p, f);
    case NoiseKind::hetero_terrain:
      return hetero_terrain(p, f);
  }
  return 0.0f;
}

/// `p` moved far away, in a direction that `seed` decides, so that its noise is independent.
template <int N>
HWY_INLINE LanesPoint<N> reseeded(const LanesPoint<N>& p, float seed) {
  LanesPoint<N> out = p;
  for (int i = 0; i < N; ++i) {
    const Lanes number = N == 1 ? hash_number(Lanes(seed)) : hash_number(Lanes(seed), Lanes(static_cast<float>(i)));
    out.v[i] = p[i] + (100.0f + number * 100.0f);
  }
  return out;
}

template <int N>
void noise_of(const Operands& o) {
  const bool is_colored = o.at.choice[3] != 0;
  for (int at = 0; at < o.count; at += kLanes) {
    const auto number = [&](int operand) { return load_lanes(o.in(operand) + at); };
    // The scale comes first, as in Blender, so that noise of scaled coordinates is the same.
    const LanesPoint<N> place = load_point<N>(o.in(0, 0), o.in(0, 1), o.in(0, 2), o.in(1), at) * number(2);
    const Fractal fractal{o.choice<NoiseKind>(1),
                          o.at.choice[2] != 0,
                          smaller(larger(number(3), -1.0f), 15.0f) + 1.0f,
                          larger(number(4), 0.0f),
                          number(5),
                          number(6),
                          number(7)};
    const Lanes distortion = number(8);
    LanesPoint<N> p = place;
    if (any(distortion != 0.0f)) {
      for (int i = 0; i < N; ++i) {
        p.v[i] = place[i] + noise_at(reseeded(place, static_cast<float>(i))) * distortion;
      }
    }
    const Lanes value = fractal_at(p, fractal);
    store_lanes(value, o.out(0) + at);
    store_lanes(value, o.out(1) + at);
    for (int c = 1; c < 3 && is_colored; ++c) {
      store_lanes(fractal_at(reseeded(p, static_cast<float>(N - 1 + c)), fractal), o.out(1 + c) + at);
    }
    for (int c = 1; c < 3 && !is_colored; ++c) store_lanes(value, o.out(1 + c) + at);
  }
}

void noise_simd(const Operands& o) {
  constexpr void (*kOf[])(const Operands&) = {noise_of<1>, noise_of<2>, noise_of<3>, noise_of<4>};
  kOf[o.at.choice[0]](o);
}

/// Distortion of a wave: fBm in [-1, 1] of the first operand, times the fifth, with detail and roughness. Leaves it in
/// the output.
void wave_noise_simd(const Operands& o) {
  for (int at = 0; at < o.count; at += kLanes) {
    const auto number = [&](int operand) { return load_lanes(o.in(operand) + at); };
    LanesPoint<3> p = load_point<3>(o.in(0, 0), o.in(0, 1), o.in(0, 2), o.in(1), at) * number(1);
    for (Lanes& x : p.v) x = (x + 0.000001f) * 0.999999f;
    const Fractal fractal{NoiseKind::fbm, true, smaller(larger(number(3), 0.0f), 15.0f) + 1.0f, number(5), 2.0f,
                          0.0f,           0.0f};
    store_lanes(number(2) * (2.0f * fbm(p * number(4), fractal) - 1.0f), o.out() + at);
  }
}

template <int N>
void white_noise_of(const Operands& o) {
  for (int at = 0; at < o.count; at += kLanes) {
    const LanesPoint<N> place = load_point<N>(o.in(0, 0), o.in(0, 1), o.in(0, 2), o.in(1), at);
    const LanesPoint<3> color = hash_color(place);
    store_lanes(color[0], o.out(0) + at);
    for (int c = 0; c < 3; ++c) store_lanes(color[c], o.out(1 + c) + at);
  }
}

void white_noise_simd(const Operands& o) {
  constexpr void (*kOf[])(const Operands&) = {white_noise_of<1>, white_noise_of<2>, white_noise_of<3>,
                                              white_noise_of<4>};
  kOf[o.at.choice[0]](o);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

namespace velour {

HWY_EXPORT(noise_simd);
HWY_EXPORT(wave_noise_simd);
HWY_EXPORT(white_noise_simd);

namespace {

/// Phase in radians without distortion.
float wave_phase(WaveKind kind, WaveAxis axis, Vec3 p) {
  p = (p + 0.000001f) * 0.999999f;  // no flicker at integers
  const bool whole = axis == WaveAxis::whole;
  if (kind == WaveKind::bands) return whole ? (p.x + p.y + p.z) * 10 : p[static_cast<int>(axis)] * 20;
  if (!whole) p[static_cast<int>(axis)] = 0;
  return glm::length(p) * 20;
}

float wave_height(WaveProfile profile, float phase) {
  constexpr float kTurn = 2 * kPi;
  if (profile == WaveProfile::sin) return 0.5f + 0.5f * std::sin(phase - kPi / 2);
  const float turns = phase / kTurn;
  if (profile == WaveProfile::saw) return turns - std::floor(turns);
  return std::abs(turns - std::floor(turns + 0.5f)) * 2;
}

void run_wave(const Operands& o) {
  bool distorted = false;
  o.each([&](int i) { distorted |= o.number(2, i) != 0; });
  if (distorted) VELOUR_SIMD_DISPATCH(wave_noise_simd)(o);
  o.each([&](int i) {
    const float phase = wave_phase(o.choice<WaveKind>(0), o.choice<WaveAxis>(1), o.number(1, i) * o.vector(0, i));
    const float bend = distorted ? o.out()[i] : 0.0f;
    o.out()[i] = wave_height(o.choice<WaveProfile>(2), phase + o.number(6, i) + bend);
  });
}

}  // namespace

void run_noise(const Operands& operands) {
  if (operands.at.operation == Operation::wave) return run_wave(operands);
  VELOUR_SIMD_DISPATCH(noise_simd)(operands);
}

void run_white_noise(const Operands& operands) { VELOUR_SIMD_DISPATCH(white_noise_simd)(operands); }

}  // namespace velour
#endif
