// Random numbers of one path: independent, or from a sequence that covers the unit square evenly.
#pragma once

#include <cstdint>
#include <span>

#include "render/options.h"
#include "render/point_batch.h"
#include "render/ray_number.h"
#include "sphere/random.h"

namespace velour {

/// Purpose of the numbers at a vertex; each has its own sequence. `lens` has the key of the next vertex' `camera`,
/// which does not exist.
enum class Purpose : uint64_t { camera, side, surface, light, sharp, onward, product_side, product, lens };

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

  /// Uniform over [0, 1): selects the lobe that the continuation ray from this vertex is attributed to.
  float label();

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

}  // namespace velour
