// The random numbers of one path, from independent numbers or from a sequence that covers the unit square evenly.
#pragma once

#include <cstdint>
#include <span>

#include "render/options.h"
#include "render/point_batch.h"
#include "render/ray_number.h"
#include "sphere/random.h"

namespace velour {

/// What numbers at a vertex are for. Each has its own sequence.
/// `lens` has the number of the next vertex' `camera`, which there is none of.
enum class Purpose : uint64_t { camera, side, surface, light, sharp, onward, product_side, product, lens };

/// `Sequence::sobol`: for every (seed, pixel, half, vertex of the path, purpose) one scrambled sequence. The camera
/// rays of a pixel, and the directions of each, take successive points of it. With a noise target or to denoise even
/// and odd camera rays are two halves, independent of each other, so that their difference tells the error (PixelSum);
/// without one they are one sequence, which errs less.
///
/// `Sequence::random`: independent numbers, with a lattice for the directions of one vertex; kept as the judge.
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

  /// From here on numbers are for the next vertex of the path.
  void next_vertex() { ++vertex_; }

  /// `u.size()` points in [0, 1)^2. `first`: how many points earlier camera rays of the half used for this purpose.
  void points(Purpose purpose, uint32_t first, std::span<Vec2> u);
  /// The same points, made together with those of other paths.
  void points(Purpose purpose, uint32_t first, int count, PointBatch& batch);
  /// One point, where every camera ray uses one.
  Vec2 point(Purpose purpose);
  void point(Purpose purpose, PointBatch& batch) { points(purpose, ray_, 1, batch); }

  /// Directions in a row, and which of the points of their purpose they take.
  struct Run {
    uint32_t first;
    int count;
  };
  /// The directions of this camera ray; `full` is how many one has that is not the last of its pixel.
  Run all(int directions, int full) const { return {ray_ * static_cast<uint32_t>(full), directions}; }

  struct Deal {
    Run rest, dealt;
  };
  /// Deals `share` of the directions out, on average: each time one of the two nearest whole numbers of them.
  Deal deal(Run run, float share, Purpose purpose);

  /// Of the ray that goes on from this vertex, before it has come to the next.
  RayDecisions decisions();

  /// Uniform over [0, 1): which lobe the ray that goes on from this vertex is said to come from.
  float label();

  /// How many camera rays of the half came before this one.
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
