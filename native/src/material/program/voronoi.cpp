// Blender's Voronoi texture (kernel/svm/voronoi.h of Cycles): one feature point a cell [Wor96], distances to it, to the
// next, or to the border between the two, summed over octaves. Highway compiles this file once for each instruction
// set.
#include "material/program/operands.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/program/voronoi.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "material/program/hash_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

constexpr float kFar = 3.4e38f;

struct VoronoiShape {
  VoronoiFeature feature;
  VoronoiMetric metric;
  bool normalizes, hashes_integers;
  Lanes scale, detail, roughness, lacunarity, smoothness, exponent, randomness;
};

template <int N>
HWY_INLINE LanesPoint<N> filled(Lanes x) {
  if constexpr (N == 1) return {{x}};
  if constexpr (N == 2) return {{x, x}};
  if constexpr (N == 3) return {{x, x, x}};
  if constexpr (N == 4) return {{x, x, x, x}};
}

/// What an octave finds: distance, color and position of a feature point.
template <int N>
struct VoronoiFind {
  Lanes distance;  // without initializers, whose implicit constructors would lack the instruction set
  LanesPoint<3> color;
  LanesPoint<N> position;
};
template <int N>
HWY_INLINE VoronoiFind<N> nothing_found() {
  return {0.0f, filled<3>(0.0f), filled<N>(0.0f)};
}

template <int N>
HWY_INLINE LanesPoint<N> operator+(const LanesPoint<N>& a, const LanesPoint<N>& b) {
  LanesPoint<N> out = a;
  for (int i = 0; i < N; ++i) out.v[i] = a[i] + b[i];
  return out;
}
template <int N>
HWY_INLINE LanesPoint<N> operator-(const LanesPoint<N>& a, const LanesPoint<N>& b) {
  LanesPoint<N> out = a;
  for (int i = 0; i < N; ++i) out.v[i] = a[i] - b[i];
  return out;
}
template <int N>
HWY_INLINE LanesPoint<N> selected(LanesMask mask, const LanesPoint<N>& yes, const LanesPoint<N>& no) {
  LanesPoint<N> out = yes;
  for (int i = 0; i < N; ++i) out.v[i] = select(mask, yes[i], no[i]);
  return out;
}
template <int N>
HWY_INLINE LanesPoint<N> lerped(const LanesPoint<N>& a, const LanesPoint<N>& b, Lanes share) {
  LanesPoint<N> out = a;
  for (int i = 0; i < N; ++i) out.v[i] = lerped(a[i], b[i], share);
  return out;
}
template <int N>
HWY_INLINE Lanes dot_of(const LanesPoint<N>& a, const LanesPoint<N>& b) {
  Lanes sum = a[0] * b[0];
  for (int i = 1; i < N; ++i) sum = sum + a[i] * b[i];
  return sum;
}

/// a^b for a >= 0, through the C library.
HWY_INLINE Lanes powers(Lanes a, Lanes b) {
  alignas(64) float x[kLanes], y[kLanes];
  store_lanes(a, x);
  store_lanes(b, y);
  for (int i = 0; i < kLanes; ++i) x[i] = std::pow(x[i], y[i]);
  return load_lanes(x);
}

/// Distance up to a monotonic function, which the nearest point does not depend on.
template <int N>
HWY_INLINE Lanes bound_of(const LanesPoint<N>& offset, const VoronoiShape& shape) {
  if (N == 1) return magnitude(offset[0]);
  if (shape.metric == VoronoiMetric::euclidean) return dot_of(offset, offset);
  Lanes sum = 0.0f;
  for (int i = 0; i < N; ++i) {
    const Lanes side = magnitude(offset[i]);
    if (shape.metric == VoronoiMetric::chebychev) {
      sum = larger(sum, side);
    } else {
      sum = sum + (shape.metric == VoronoiMetric::manhattan ? side : powers(side, shape.exponent));
    }
  }
  return sum;
}
template <int N>
HWY_INLINE Lanes distance_of_bound(Lanes bound, const VoronoiShape& shape) {
  if (N == 1) return bound;
  if (shape.metric == VoronoiMetric::euclidean) return square_root(bound);
  return shape.metric == VoronoiMetric::minkowski ? powers(bound, 1.0f / shape.exponent) : bound;
}
template <int N>
HWY_INLINE Lanes distance_of(const LanesPoint<N>& offset, const VoronoiShape& shape) {
  return distance_of_bound<N>(bound_of(offset, shape), shape);
}

// Feature points. Up to Blender 4.5 the hash is that of the coordinates' bit patterns; since 5.0 it is [JO20] of
// integers, except in 1D.

HWY_INLINE Bits scrambled(Bits x) { return x * Bits(1664525u) + Bits(1013904223u); }
HWY_INLINE Lanes share_of_bits(Bits x) { return number_of(x & Bits(0x7fffffffu)) * (1.0f / 2147483647.0f); }

HWY_INLINE LanesPoint<2> integer_hash(const LanesPoint<2>& p) {
  Bits x = scrambled(integer_of(p[0])), y = scrambled(integer_of(p[1]));
  for (int round = 0; round < 2; ++round) {
    x = x + y * Bits(1664525u);
    y = y + x * Bits(1664525u);
    if (round > 0) break;
    x = x ^ shifted_arithmetically<16>(x);
    y = y ^ shifted_arithmetically<16>(y);
  }
  return {{share_of_bits(x), share_of_bits(y)}};
}
HWY_INLINE LanesPoint<3> integer_hash(const LanesPoint<3>& p) {
  Bits x = scrambled(integer_of(p[0])), y = scrambled(integer_of(p[1])), z = scrambled(integer_of(p[2]));
  for (int round = 0; round < 2; ++round) {
    x = x + y * z;
    y = y + z * x;
    z = z + x * y;
    if (round > 0) break;
    x = x ^ shifted_arithmetically<16>(x);
    y = y ^ shifted_arithmetically<16>(y);
    z = z ^ shifted_arithmetically<16>(z);
  }
  return {{share_of_bits(x), share_of_bits(y), share_of_bits(z)}};
}
HWY_INLINE LanesPoint<4> integer_hash(const LanesPoint<4>& p) {
  Bits x = scrambled(integer_of(p[0])), y = scrambled(integer_of(p[1])), z = scrambled(integer_of(p[2])),
       w = scrambled(integer_of(p[3]));
  for (int round = 0; round < 2; ++round) {
    x = x + y * w;
    y = y + z * x;
    z = z + x * y;
    w = w + y * z;
    if (round > 0) break;
    x = x ^ shifted_arithmetically<16>(x);
    y = y ^ shifted_arithmetically<16>(y);
    z = z ^ shifted_arithmetically<16>(z);
    w = w ^ shifted_arithmetically<16>(w);
  }
  return {{share_of_bits(x), share_of_bits(y), share_of_bits(z), share_of_bits(w)}};
}

template <int N>
HWY_INLINE LanesPoint<N> feature_hash(const LanesPoint<N>& cell, const VoronoiShape& shape) {
  if constexpr (N == 1) {
    return {{hash_number(cell[0])}};
  } else {
    if (shape.hashes_integers) return integer_hash(cell);
    if constexpr (N == 2) return {{hash_number(cell[0], cell[1]), hash_number(cell[0], cell[1], Lanes(1.0f))}};
    if constexpr (N == 3) return hash_color(cell);
    if constexpr (N == 4) {
      return {{hash_number(cell[0], cell[1], cell[2], cell[3]), hash_number(cell[3], cell[0], cell[1], cell[2]),
               hash_number(cell[2], cell[3], cell[0], cell[1]), hash_number(cell[1], cell[2], cell[3], cell[0])}};
    }
  }
}

template <int N>
HWY_INLINE LanesPoint<3> cell_color(const LanesPoint<N>& cell, const VoronoiShape& shape) {
  if constexpr (N == 2) {
    if (shape.hashes_integers) return integer_hash(LanesPoint<3>{{cell[0], cell[1], 0.0f}});
  }
  if constexpr (N == 3) {
    if (shape.hashes_integers) return integer_hash(cell);
  }
  if constexpr (N == 4) {
    if (shape.hashes_integers) {
      const LanesPoint<4> all = integer_hash(cell);
      return {{all[0], all[1], all[2]}};
    }
  }
  return hash_color(cell);
}

/// Feature point of the cell at `offset` from `cell`, relative to `cell`.
template <int N>
HWY_INLINE LanesPoint<N> feature_point(const LanesPoint<N>& cell, const LanesPoint<N>& offset,
                                       const VoronoiShape& shape) {
  return offset + feature_hash(cell + offset, shape) * shape.randomness;
}

/// Calls f(offset) for all cells within `kReach` of the middle one, in Blender's order.
template <int N, int kReach, class F>
HWY_INLINE void each_cell(const F& f) {
  constexpr int kSide = 2 * kReach + 1;
  int count = 1;
  for (int i = 0; i < N; ++i) count *= kSide;
  for (int number = 0; number < count; ++number) {
    LanesPoint<N> offset = filled<N>(0.0f);
    int rest = number;
    for (int i = 0; i < N; ++i, rest /= kSide) offset.v[i] = static_cast<float>(rest % kSide - kReach);
    f(offset);
  }
}

template <int N>
struct Cell {
  LanesPoint<N> corner, place;  // of the cell, and of the point relative to it

  HWY_INLINE explicit Cell(const LanesPoint<N>& p) : corner(p), place(p) {
    for (int i = 0; i < N; ++i) {
      corner.v[i] = floor_of(p[i]);
      place.v[i] = p[i] - corner[i];
    }
  }
};

template <int N>
HWY_INLINE VoronoiFind<N> nearest(const LanesPoint<N>& p, const VoronoiShape& shape) {
  const Cell<N> cell(p);
  Lanes least = kFar;
  LanesPoint<N> target_offset = filled<N>(0.0f), target = filled<N>(0.0f);
  each_cell<N, 1>([&](const LanesPoint<N>& offset) {
    const LanesPoint<N> point = feature_point(cell.corner, offset, shape);
    const Lanes bound = bound_of(point - cell.place, shape);
    const LanesMask closer = bound < least;
    least = select(closer, bound, least);
    target_offset = selected(closer, offset, target_offset);
    target = selected(closer, point, target);
  });
  return {distance_of_bound<N>(least, shape), cell_color(cell.corner + target_offset, shape), target + cell.corner};
}

template <int N>
HWY_INLINE VoronoiFind<N> second_nearest(const LanesPoint<N>& p, const VoronoiShape& shape) {
  const Cell<N> cell(p);
  Lanes first = kFar, second = kFar;
  LanesPoint<N> first_offset = filled<N>(0.0f), second_offset = first_offset, first_point = first_offset,
                second_point = first_offset;
  each_cell<N, 1>([&](const LanesPoint<N>& offset) {
    const LanesPoint<N> point = feature_point(cell.corner, offset, shape);
    const Lanes bound = bound_of(point - cell.place, shape);
    const LanesMask is_first = bound < first, is_second = bound < second;
    second = select(is_first, first, select(is_second, bound, second));
    second_offset = selected(is_first, first_offset, selected(is_second, offset, second_offset));
    second_point = selected(is_first, first_point, selected(is_second, point, second_point));
    first = select(is_first, bound, first);
    first_offset = selected(is_first, offset, first_offset);
    first_point = selected(is_first, point, first_point);
  });
  return {distance_of_bound<N>(second, shape), cell_color(cell.corner + second_offset, shape),
          second_point + cell.corner};
}

template <int N>
HWY_INLINE VoronoiFind<N> smooth_nearest(const LanesPoint<N>& p, const VoronoiShape& shape) {
  const Cell<N> cell(p);
  VoronoiFind<N> found = nothing_found<N>();
  bool first = true;
  each_cell<N, 2>([&](const LanesPoint<N>& offset) {
    const LanesPoint<N> point = feature_point(cell.corner, offset, shape);
    const Lanes distance = distance_of(point - cell.place, shape);
    const Lanes x = smaller(larger(0.5f + 0.5f * (found.distance - distance) / shape.smoothness, 0.0f), 1.0f);
    const Lanes share = first ? Lanes(1.0f) : x * x * (3.0f - 2.0f * x);
    const Lanes dip = shape.smoothness * share * (1.0f - share);
    const Lanes small_dip = dip / (1.0f + 3.0f * shape.smoothness);
    found.distance = lerped(found.distance, distance, share) - dip;
    found.color = lerped(found.color, cell_color(cell.corner + offset, shape), share) - filled<3>(small_dip);
    found.position = lerped(found.position, point, share) - filled<N>(small_dip);
    first = false;
  });
  found.position = found.position + cell.corner;
  return found;
}

template <int N>
HWY_INLINE Lanes to_edge(const LanesPoint<N>& p, const VoronoiShape& shape) {
  const Cell<N> cell(p);
  Lanes least = kFar;
  if constexpr (N == 1) {
    const auto at = [&](float offset) { return feature_point(cell.corner, filled<1>(offset), shape)[0]; };
    const Lanes middle = at(0.0f);
    const auto border = [&](float side) { return magnitude((middle + at(side)) * 0.5f - cell.place[0]); };
    return smaller(border(-1.0f), border(1.0f));
  } else {
    LanesPoint<N> closest = filled<N>(0.0f);
    each_cell<N, 1>([&](const LanesPoint<N>& offset) {
      const LanesPoint<N> to_point = feature_point(cell.corner, offset, shape) - cell.place;
      const Lanes square = dot_of(to_point, to_point);
      const LanesMask closer = square < least;
      least = select(closer, square, least);
      closest = selected(closer, to_point, closest);
    });
    least = kFar;
    each_cell<N, 1>([&](const LanesPoint<N>& offset) {
      const LanesPoint<N> to_point = feature_point(cell.corner, offset, shape) - cell.place;
      const LanesPoint<N> across = to_point - closest;
      const Lanes square = dot_of(across, across);
      const Lanes distance = dot_of((closest + to_point) * 0.5f, across) / square_root(square);
      least = select(square > 0.0001f, smaller(least, distance), least);
    });
    return least;
  }
}

/// Half of the distance between the nearest feature point and the one nearest to that.
template <int N>
HWY_INLINE Lanes sphere_radius(const LanesPoint<N>& p, const VoronoiShape& shape) {
  const Cell<N> cell(p);
  Lanes least = kFar;
  LanesPoint<N> closest = filled<N>(0.0f), closest_offset = closest;
  each_cell<N, 1>([&](const LanesPoint<N>& offset) {
    const LanesPoint<N> point = feature_point(cell.corner, offset, shape), to_point = point - cell.place;
    const Lanes square = dot_of(to_point, to_point);
    const LanesMask closer = square < least;
    least = select(closer, square, least);
    closest = selected(closer, point, closest);
    closest_offset = selected(closer, offset, closest_offset);
  });
  least = kFar;
  each_cell<N, 1>([&](const LanesPoint<N>& offset) {
    const LanesPoint<N> to_point = feature_point(cell.corner, offset + closest_offset, shape) - closest;
    const Lanes square = dot_of(to_point, to_point);
    least = select(dot_of(offset, offset) > 0.0f, smaller(least, square), least);
  });
  return 0.5f * square_root(least);
}

template <int N>
HWY_INLINE VoronoiFind<N> octave_of(const LanesPoint<N>& p, const VoronoiShape& shape) {
  if (shape.feature == VoronoiFeature::f2) return second_nearest(p, shape);
  if (shape.feature == VoronoiFeature::smooth_f1 && any(shape.smoothness != 0.0f)) return smooth_nearest(p, shape);
  return nearest(p, shape);
}

/// Largest distance of F1.
template <int N>
HWY_INLINE Lanes largest_distance(const VoronoiShape& shape) {
  return distance_of(filled<N>(0.5f + 0.5f * shape.randomness), shape);
}

// Octaves. `detail` is their number less 1; the last counts partly.

template <int N>
HWY_INLINE VoronoiFind<N> summed(const LanesPoint<N>& p, const VoronoiShape& shape) {
  Lanes amplitude = 1.0f, total = 0.0f, scale = 1.0f;
  VoronoiFind<N> sum = nothing_found<N>();
  for (int i = 0;; ++i) {
    const Lanes at(static_cast<float>(i));
    const Lanes part = smaller(larger(shape.detail - at + 1.0f, 0.0f), 1.0f);
    if (!any(part > 0.0f)) break;
    const VoronoiFind<N> octave = octave_of(p * scale, shape);
    const Lanes share = part * amplitude;
    total = total + share;
    sum.distance = sum.distance + octave.distance * share;
    sum.color = sum.color + octave.color * share;
    sum.position = lerped(sum.position, octave.position * (1.0f / scale), share);
    scale = scale * shape.lacunarity;
    amplitude = amplitude * shape.roughness;
  }
  if (shape.normalizes) {
    const float farther = shape.feature == VoronoiFeature::f2 ? 2.0f : 1.0f;
    sum.distance = sum.distance / (total * (largest_distance<N>(shape) * farther));
    sum.color = sum.color * (1.0f / total);
  }
  sum.position = sum.position * select(shape.scale != 0.0f, 1.0f / shape.scale, 0.0f);
  return sum;
}

template <int N>
HWY_INLINE Lanes edges_summed(const LanesPoint<N>& p, const VoronoiShape& shape) {
  const Lanes largest = 0.5f + 0.5f * shape.randomness;
  Lanes amplitude = 1.0f, total = largest, scale = 1.0f, distance = 8.0f;
  for (int i = 0;; ++i) {
    const Lanes at(static_cast<float>(i));
    const Lanes part = smaller(larger(shape.detail - at + 1.0f, 0.0f), 1.0f);
    if (!any(part > 0.0f)) break;
    const Lanes closer = smaller(distance, to_edge(p * scale, shape) / scale);
    distance = lerped(distance, lerped(distance, closer, amplitude), part);
    total = lerped(total, lerped(total, largest / scale, amplitude), part);
    scale = scale * shape.lacunarity;
    amplitude = amplitude * shape.roughness;
  }
  return shape.normalizes ? distance / total : distance;
}

template <int N>
void voronoi_of(const Operands& o) {
  const auto put = [&](Lanes value, int component, int at) { store_lanes(value, o.out(component) + at); };
  for (int at = 0; at < o.count; at += kLanes) {
    const auto number = [&](int operand) { return load_lanes(o.in(operand) + at); };
    const auto limited = [&](Lanes x, float high) { return smaller(larger(x, 0.0f), high); };
    const int flags = o.at.choice[3];
    const Lanes roughness = limited(number(4), 1.0f);
    const VoronoiShape shape{o.choice<VoronoiFeature>(1),
                             o.choice<VoronoiMetric>(2),
                             (flags & 1) != 0,
                             (flags & 2) != 0,
                             number(2),
                             select(roughness > 0.0f, limited(number(3), 15.0f), 0.0f),
                             roughness,
                             number(5),
                             limited(number(6) * 0.5f, 0.5f),
                             number(7),
                             limited(number(8), 1.0f)};
    const LanesPoint<N> p = load_point<N>(o.in(0, 0), o.in(0, 1), o.in(0, 2), o.in(1), at) * shape.scale;
    for (int component = 0; component < 9; ++component) put(0.0f, component, at);
    if (shape.feature == VoronoiFeature::n_sphere_radius) {
      put(sphere_radius(p, shape), 8, at);
    } else if (shape.feature == VoronoiFeature::distance_to_edge) {
      put(edges_summed(p, shape), 0, at);
    } else {
      const VoronoiFind<N> found = summed(p, shape);
      put(found.distance, 0, at);
      for (int c = 0; c < 3; ++c) put(found.color[c], 1 + c, at);
      constexpr int kInVector = N == 1 ? 0 : N == 2 ? 2 : 3;
      for (int i = 0; i < kInVector; ++i) put(found.position[i], 4 + i, at);
      if (N == 1 || N == 4) put(found.position[N - 1], 7, at);
    }
  }
}

void voronoi_simd(const Operands& o) {
  constexpr void (*kOf[])(const Operands&) = {voronoi_of<1>, voronoi_of<2>, voronoi_of<3>, voronoi_of<4>};
  kOf[o.at.choice[0]](o);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(voronoi_simd);

void run_voronoi(const Operands& operands) { VELOUR_SIMD_DISPATCH(voronoi_simd)(operands); }

}  // namespace velour
#endif
