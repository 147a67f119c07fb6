// Integer lanes beside the numbers of lanes-inl.h, and the hashes of Blender's textures. Included once per instruction
// set by sources that use foreach_target.h.
#if defined(VELOUR_HASH_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_HASH_LANES_INL_H_
#undef VELOUR_HASH_LANES_INL_H_
#else
#define VELOUR_HASH_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "math/sphere/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

#if HWY_HAVE_SCALABLE
using Bits = uint32_t;
using LanesMask = bool;
HWY_INLINE Lanes floor_of(Lanes x) { return std::floor(x); }
HWY_INLINE Lanes magnitude(Lanes x) { return std::abs(x); }
HWY_INLINE Bits integer_of(Lanes x) { return static_cast<uint32_t>(static_cast<int32_t>(x)); }
HWY_INLINE Lanes number_of(Bits x) { return static_cast<float>(x); }
HWY_INLINE Bits bits_of(Lanes x) { return std::bit_cast<uint32_t>(x); }
HWY_INLINE Lanes flipped(Lanes x, Bits h, int bit) { return (h >> bit & 1) != 0 ? -x : x; }
template <int kBits>
HWY_INLINE Bits rotated(Bits x) {
  return std::rotl(x, kBits);
}
template <int kBits>
HWY_INLINE Bits shifted_arithmetically(Bits x) {
  return static_cast<uint32_t>(static_cast<int32_t>(x) >> kBits);
}
HWY_INLINE bool any(LanesMask mask) { return mask; }
HWY_INLINE Bits select_bits(LanesMask mask, Bits yes, Bits no) { return mask ? yes : no; }
HWY_INLINE LanesMask is_below(Bits x, uint32_t limit) { return x < limit; }
HWY_INLINE LanesMask is_equal(Bits x, uint32_t other) { return x == other; }
HWY_INLINE LanesMask both(LanesMask a, LanesMask b) { return a && b; }
HWY_INLINE LanesMask either(LanesMask a, LanesMask b) { return a || b; }
HWY_INLINE LanesMask excluding(LanesMask a, LanesMask b) { return a && !b; }
#else
using BitsTag = hn::RebindToUnsigned<LanesTag>;
using IntegerTag = hn::RebindToSigned<LanesTag>;

struct Bits {
  hn::Vec<BitsTag> v;

  HWY_INLINE Bits() : v(hn::Zero(BitsTag())) {}
  HWY_INLINE Bits(uint32_t x) : v(hn::Set(BitsTag(), x)) {}
  HWY_INLINE explicit Bits(hn::Vec<BitsTag> bits) : v(bits) {}
};
HWY_INLINE Bits operator+(Bits a, Bits b) { return Bits(hn::Add(a.v, b.v)); }
HWY_INLINE Bits operator-(Bits a, Bits b) { return Bits(hn::Sub(a.v, b.v)); }
HWY_INLINE Bits operator*(Bits a, Bits b) { return Bits(hn::Mul(a.v, b.v)); }
HWY_INLINE Bits operator^(Bits a, Bits b) { return Bits(hn::Xor(a.v, b.v)); }
HWY_INLINE Bits operator&(Bits a, Bits b) { return Bits(hn::And(a.v, b.v)); }

HWY_INLINE Lanes floor_of(Lanes x) { return Lanes(hn::Floor(x.v)); }
HWY_INLINE Lanes magnitude(Lanes x) { return Lanes(hn::Abs(x.v)); }
/// Two's complement of the integer part.
HWY_INLINE Bits integer_of(Lanes x) { return Bits(hn::BitCast(BitsTag(), hn::ConvertTo(IntegerTag(), x.v))); }
HWY_INLINE Lanes number_of(Bits x) { return Lanes(hn::ConvertTo(LanesTag(), x.v)); }
HWY_INLINE Bits bits_of(Lanes x) { return Bits(hn::BitCast(BitsTag(), x.v)); }
/// -x where the bit of `h` is set.
HWY_INLINE Lanes flipped(Lanes x, Bits h, int bit) {
  const auto sign = hn::ShiftLeftSame(hn::And(h.v, hn::Set(BitsTag(), 1u << bit)), 31 - bit);
  return Lanes(hn::BitCast(LanesTag(), hn::Xor(hn::BitCast(BitsTag(), x.v), sign)));
}
/// Rotated to the left.
template <int kBits>
HWY_INLINE Bits rotated(Bits x) {
  return Bits(hn::RotateRight<32 - kBits>(x.v));
}
template <int kBits>
HWY_INLINE Bits shifted_arithmetically(Bits x) {
  return Bits(hn::BitCast(BitsTag(), hn::ShiftRight<kBits>(hn::BitCast(IntegerTag(), x.v))));
}
HWY_INLINE bool any(LanesMask mask) { return !hn::AllFalse(LanesTag(), mask.v); }
HWY_INLINE Bits select_bits(LanesMask mask, Bits yes, Bits no) {
  return Bits(hn::IfThenElse(hn::RebindMask(BitsTag(), mask.v), yes.v, no.v));
}
HWY_INLINE LanesMask is_below(Bits x, uint32_t limit) {
  return {hn::RebindMask(LanesTag(), hn::Lt(x.v, hn::Set(BitsTag(), limit)))};
}
HWY_INLINE LanesMask is_equal(Bits x, uint32_t other) {
  return {hn::RebindMask(LanesTag(), hn::Eq(x.v, hn::Set(BitsTag(), other)))};
}
HWY_INLINE LanesMask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE LanesMask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE LanesMask operator!=(Lanes a, Lanes b) { return {hn::Ne(a.v, b.v)}; }
HWY_INLINE LanesMask both(LanesMask a, LanesMask b) { return {hn::And(a.v, b.v)}; }
HWY_INLINE LanesMask either(LanesMask a, LanesMask b) { return {hn::Or(a.v, b.v)}; }
HWY_INLINE LanesMask excluding(LanesMask a, LanesMask b) { return {hn::AndNot(b.v, a.v)}; }
#endif

HWY_INLINE Lanes lerped(Lanes a, Lanes b, Lanes share) { return a + share * (b - a); }

// Lookup3 [Jen06] of one to four integers.

HWY_INLINE void finish_hash(Bits& a, Bits& b, Bits& c) {
  c = (c ^ b) - rotated<14>(b);
  a = (a ^ c) - rotated<11>(c);
  b = (b ^ a) - rotated<25>(a);
  c = (c ^ b) - rotated<16>(b);
  a = (a ^ c) - rotated<4>(c);
  b = (b ^ a) - rotated<14>(a);
  c = (c ^ b) - rotated<24>(b);
}

/// Where all of a hash's words start.
constexpr uint32_t hash_start(uint32_t count) { return 0xdeadbeefu + (count << 2) + 13; }

HWY_INLINE Bits hash_of(Bits x) {
  Bits a = Bits(hash_start(1)) + x, b(hash_start(1)), c(hash_start(1));
  finish_hash(a, b, c);
  return c;
}
HWY_INLINE Bits hash_of(Bits x, Bits y) {
  Bits a = Bits(hash_start(2)) + x, b = Bits(hash_start(2)) + y, c(hash_start(2));
  finish_hash(a, b, c);
  return c;
}
HWY_INLINE Bits hash_of(Bits x, Bits y, Bits z) {
  Bits a = Bits(hash_start(3)) + x, b = Bits(hash_start(3)) + y, c = Bits(hash_start(3)) + z;
  finish_hash(a, b, c);
  return c;
}
HWY_INLINE Bits hash_of(Bits x, Bits y, Bits z, Bits w) {
  Bits a = Bits(hash_start(4)) + x, b = Bits(hash_start(4)) + y, c = Bits(hash_start(4)) + z;
  a = (a - c) ^ rotated<4>(c);
  c = c + b;
  b = (b - a) ^ rotated<6>(a);
  a = a + c;
  c = (c - b) ^ rotated<8>(b);
  b = b + a;
  a = (a - c) ^ rotated<16>(c);
  c = c + b;
  b = (b - a) ^ rotated<19>(a);
  a = a + c;
  c = (c - b) ^ rotated<4>(b);
  b = b + a;
  a = a + w;
  finish_hash(a, b, c);
  return c;
}

/// Number in [0, 1] of the bit patterns of numbers.
template <class... T>
HWY_INLINE Lanes hash_number(T... x) {
  return number_of(hash_of(bits_of(x)...)) * (1.0f / 4294967295.0f);
}

/// A point of `N` dimensions in each lane.
template <int N>
struct LanesPoint {
  Lanes v[N];

  HWY_INLINE Lanes operator[](int i) const { return v[i]; }
};
template <int N>
HWY_INLINE LanesPoint<N> operator*(const LanesPoint<N>& p, Lanes scale) {
  LanesPoint<N> out = p;
  for (int i = 0; i < N; ++i) out.v[i] = p.v[i] * scale;
  return out;
}

/// Point `at` of a vector operand and a number for the last dimension, as Blender's textures take them: 1D the number,
/// 2D and 3D the vector, 4D both.
template <int N>
HWY_INLINE LanesPoint<N> load_point(const float* x, const float* y, const float* z, const float* w, int at) {
  const Lanes last = load_lanes(w + at), first = load_lanes(x + at);
  if constexpr (N == 1) return {{last}};
  if constexpr (N == 2) return {{first, load_lanes(y + at)}};
  if constexpr (N == 3) return {{first, load_lanes(y + at), load_lanes(z + at)}};
  if constexpr (N == 4) return {{first, load_lanes(y + at), load_lanes(z + at), last}};
}

/// Numbers in [0, 1] of a point's coordinates: three.
HWY_INLINE LanesPoint<3> hash_color(const LanesPoint<1>& p) {
  return {{hash_number(p[0]), hash_number(p[0], Lanes(1.0f)), hash_number(p[0], Lanes(2.0f))}};
}
HWY_INLINE LanesPoint<3> hash_color(const LanesPoint<2>& p) {
  return {{hash_number(p[0], p[1]), hash_number(p[0], p[1], Lanes(1.0f)), hash_number(p[0], p[1], Lanes(2.0f))}};
}
HWY_INLINE LanesPoint<3> hash_color(const LanesPoint<3>& p) {
  return {{hash_number(p[0], p[1], p[2]), hash_number(p[0], p[1], p[2], Lanes(1.0f)),
           hash_number(p[0], p[1], p[2], Lanes(2.0f))}};
}
HWY_INLINE LanesPoint<3> hash_color(const LanesPoint<4>& p) {
  return {
      {hash_number(p[0], p[1], p[2], p[3]), hash_number(p[2], p[0], p[3], p[1]), hash_number(p[3], p[2], p[1], p[0])}};
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif
