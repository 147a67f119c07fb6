// Random numbers of one path: independent, or from a sequence that covers the unit square evenly.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include "math/sphere/random.h"
#include "math/sphere/vec.h"
#include "render/options.h"
#include "scene/embree_scene.h"

namespace velour {

// Points of many sequences, generated together.

/// Up to kCapacity points in [0, 1)^2: add, then resolve(), then read. Each sequence contributes only a few points;
/// vectors run over the points of all of them.
class PointBatch {
 public:
  static constexpr int kCapacity = 64;

  void clear() { count_ = 0; }
  int count() const { return count_; }
  /// Adds points `first`, `first` + 1, ... of the Sobol sequence `seeds`.
  void add(const SobolSeeds& seeds, uint32_t first, int count) {
    pending_ = true;
    for (uint32_t i = 0; i < static_cast<uint32_t>(count); ++i, ++count_) {
      index_[count_] = first + i;
      order_[count_] = seeds.order;
      seed_x_[count_] = seeds.x;
      seed_y_[count_] = seeds.y;
    }
  }
  /// Adds `count` points that the caller sets at once, for numbers without a sequence. Must not be mixed with the
  /// others.
  std::span<Vec2> add(int count) {
    count_ += count;
    return {points_ + count_ - count, static_cast<size_t>(count)};
  }
  /// Generates the requested points. Run-time dispatched SIMD; bit-identical to sobol_points.
  void resolve();

  std::span<const Vec2> points(int first, int count) const { return {points_ + first, static_cast<size_t>(count)}; }

  // Arguments of the kernel.
  struct Lanes {
    const uint32_t *index, *order, *seed_x, *seed_y;
    float* points;  // x and y interleaved
    int count;
  };

 private:
  int count_ = 0;
  bool pending_ = false;
  alignas(64) uint32_t index_[kCapacity] = {}, order_[kCapacity] = {}, seed_x_[kCapacity] = {}, seed_y_[kCapacity] = {};
  alignas(64) Vec2 points_[kCapacity];
};

// Random decisions of a ray at a surface, independent of threads and order.

enum class RayDecision : uint64_t { alpha = 1, shell_edge };

/// Uniform over [0, 1), hashed from the bits of ray and triangle.
inline float ray_number(const Ray& ray, const Hit& hit, RayDecision decision) {
  uint64_t key = mix64((static_cast<uint64_t>(hit.instance) << 32) + hit.triangle) + static_cast<uint64_t>(decision);
  for (const Vec3& v : {ray.origin, ray.direction}) {
    for (int i = 0; i < 3; ++i) key = mix64(key + std::bit_cast<uint32_t>(v[i]));
  }
  return unit_float(key);
}

/// Source of decisions for one of many related rays, such as the camera rays of a pixel: a key that they share, and the
/// index of the ray.
struct RayDecisions {
  uint64_t key;
  uint32_t index;

  /// Uniform over [0, 1), for the decision that follows `before` others. Stratified over successive rays: of 2^m
  /// aligned rays, one falls into each interval of length 2^-m.
  float number(uint32_t before) const {
    Vec2 u;
    sobol_points(mix64(key + before), index, {&u, 1});
    return u.x;
  }
};

/// Purpose of the numbers at a vertex; each has its own sequence. `lens` has the key of the next vertex' `camera`,
/// which does not exist.
enum class Purpose : uint64_t { camera, side, surface, light, sharp, continuation, product_side, product, lens };

/// `Sequence::sobol`: one scrambled sequence for every (seed, pixel, half, vertex of the path, purpose). The camera
/// rays of a pixel and the directions of each take successive points of it. With a noise target or denoising, even and
/// odd camera rays form two independent halves, whose difference gives the error (PixelSum); otherwise they form one
/// sequence, which errs less.
///
/// `Sequence::random`: independent numbers, with a lattice for the directions of one vertex; kept as a reference.
///
/// `Sequence::independent`: without the lattice, as in the dissertation.
class PathNumbers {
 public:
  /// Uses seed, sequence, noise and denoise of `options`.
  PathNumbers(const RenderOptions& options, uint64_t pixel, uint32_t camera_ray)
      : sequence_(options.numbers()),
        random_(options.seed, pixel, sequence_ == Sequence::sobol ? camera_ray % halves(options) : camera_ray),
        ray_(camera_ray / halves(options)) {
    if (sequence_ == Sequence::sobol) key_ = random_.next_bits();
  }

  /// Subsequent numbers are for the next vertex of the path.
  void next_vertex() { ++vertex_; }

  /// `u.size()` points in [0, 1)^2. `first`: number of points that earlier camera rays of the half used for this
  /// purpose.
  void points(Purpose purpose, uint32_t first, std::span<Vec2> u);
  /// Requests these points from a batch that generates them with those of other paths.
  void points(Purpose purpose, uint32_t first, int count, PointBatch& batch);
  /// One point, for purposes with one point per camera ray.
  Vec2 point(Purpose purpose);
  void point(Purpose purpose, PointBatch& batch) { points(purpose, ray_, 1, batch); }

  /// Consecutive directions, and the first point of their purpose that they take.
  struct Run {
    uint32_t first;
    int count;
  };
  /// The directions of this camera ray; `full`: number of directions of a camera ray other than the last of its pixel.
  Run all(int directions, int full) const { return {ray_ * static_cast<uint32_t>(full), directions}; }

  struct Deal {
    Run rest, dealt;
  };
  /// Deals out `share` of the directions on average: each time one of the two nearest integers.
  Deal deal(Run run, float share, Purpose purpose);

  /// Decisions of the continuation ray from this vertex, before it reaches the next.
  RayDecisions decisions();

  /// Requests a point whose first coordinate decides about the time of a camera ray.
  void time(PointBatch& batch);

  /// Uniform over [0, 1): decides whether the continuation ray from this vertex counts as diffuse.
  float label();

  /// Uniform over [0, 1): selects the lobe that the continuation ray from this vertex follows.
  float lobe();

  /// Number of camera rays of the half before this one.
  uint32_t ray() const { return ray_; }

 private:
  static uint32_t halves(const RenderOptions& options) { return options.noise > 0.0 || options.denoise ? 2 : 1; }
  uint64_t key(Purpose purpose) const {
    return mix64(key_ + (vertex_ * 8 + static_cast<uint64_t>(purpose)) * 0x9e3779b97f4a7c15ULL);
  }

  Sequence sequence_;
  RandomStream random_;
  uint32_t ray_;
  uint64_t key_ = 0, vertex_ = 0;
};

// Point sets of the unit square for the directions of one camera ray.

/// Point `i` of `n` of a Fibonacci-like rank-1 lattice, shifted by `shift` modulo 1 [CP76]. With a uniform shift every
/// point is uniform in [0, 1)^2, and together they cover the square evenly.
inline Vec2 lattice_point(int i, int n, const Vec2& shift) {
  const float x = static_cast<float>(i) / static_cast<float>(n) + shift.x;
  const float y = static_cast<float>(i) * static_cast<float>(kGoldenRatio) + shift.y;
  constexpr float kBelowOne = 0x1.fffffep-1f;
  return {std::min(x - std::floor(x), kBelowOne), std::min(y - std::floor(y), kBelowOne)};
}

}  // namespace velour
