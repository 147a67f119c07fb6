// Sets of directions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

/// `n` directions of equal solid angle 2 pi / n on the upper hemisphere (spherical Fibonacci lattice, cell centers).
std::vector<Vec3> hemisphere_fibonacci(int n);

/// `n` directions of equal solid angle 4 pi / n on the whole sphere.
std::vector<Vec3> sphere_fibonacci(int n);

/// Indices of the `k` directions of `set` with the largest dot product with `d`, nearest first; ties by lower index.
/// Writes min(k, set.size()) indices and returns how many.
int nearest_directions(std::span<const Vec3> set, const Vec3& d, int k, int* indices);
/// Considers only the directions of `set` whose indices are in `among`, which is ascending.
int nearest_directions(std::span<const Vec3> set, std::span<const uint32_t> among, const Vec3& d, int k, int* indices);

// Batches of directions, the unit of work of every evaluation kernel. SIMD lanes run over directions, so a lobe is
// broadcast and no horizontal sum is needed.

/// Up to kCapacity unit directions, structure of arrays. Lanes past `count` hold +z, so kernels never branch on a tail.
struct alignas(64) DirectionBatch {
  static constexpr int kCapacity = 64;
  float x[kCapacity], y[kCapacity], z[kCapacity];
  int count = 0;

  Vec3 get(int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Vec3& d) {
    x[i] = d.x;
    y[i] = d.y;
    z[i] = d.z;
  }
  void push(const Vec3& d) { set(count++, d); }
  /// Sets the batch to draw(u) for each of `numbers`, without padding.
  template <typename Draw>
  void fill(std::span<const Vec2> numbers, Draw&& draw) {
    count = 0;
    for (const Vec2& u : numbers) push(draw(u));
  }
  /// Fills the lanes from `count` up to a multiple of 16. Call once after the last push.
  void pad() {
    for (int i = count; i % 16 != 0; ++i) set(i, {0, 0, 1});
  }
};

/// One RGB value per direction of a batch.
struct alignas(64) RgbBatch {
  float r[DirectionBatch::kCapacity], g[DirectionBatch::kCapacity], b[DirectionBatch::kCapacity];

  Rgb get(int i) const { return {r[i], g[i], b[i]}; }
  void set(int i, const Rgb& c) {
    r[i] = c.r;
    g[i] = c.g;
    b[i] = c.b;
  }
};

/// One scalar per direction of a batch.
struct alignas(64) ScalarBatch {
  float v[DirectionBatch::kCapacity];
};

}  // namespace velour
