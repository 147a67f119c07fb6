// Stopping criteria of a render: the errors of the image, and of the denoised image, estimated from the film.
#pragma once

#include <limits>
#include <span>
#include <vector>
#include "base/progress.h"
#include "render/film/film.h"

namespace velour {

// Stopping criterion of a render: the error of each block of pixels, estimated from the film alone.

/// Cuts an image into blocks of about 16 x 16 pixels, none much smaller; they are also the tiles of the work.
std::vector<PixelRect> blocks_of(const PixelRect& picture);

/// Estimated variance of the luminance of pixels, and their luminance; means over the pixels of a block.
struct BlockError {
  double variance = 0, luminance = 0;
  bool known = false;  // every pixel has at least one camera ray in each half

  /// sqrt(variance) relative to sqrt(L_b^2 + 0.01 L^2), with L_b the mean luminance of the block and L that of the
  /// image: as in relmse, a dark block needs no more accuracy than the eye sees. Infinite if one of them is not finite.
  double relative_to(double picture_luminance) const;
};
BlockError block_error(std::span<const PixelSum> pixels);

/// Blocks that still need camera rays. Decides at fixed numbers of camera rays, so the image depends neither on threads
/// nor on how passes are cut. A block is done when its error is at most the target at two successive decisions, the
/// first of which comes after kRaysAtLeast camera rays; a single lucky estimate before a firefly appears does not
/// suffice.
class NoiseTarget {
 public:
  static constexpr int kRaysAtLeast = 8;

  /// `target` 0: no block is ever done.
  NoiseTarget(double target, std::vector<PixelRect> blocks);

  bool enabled() const { return target_ > 0.0; }
  std::span<const PixelRect> blocks() const { return blocks_; }
  /// Indices of the blocks that are not done.
  const std::vector<size_t>& active() const { return active_; }
  /// Number of camera rays per pixel at the next decision; a pass must not exceed it.
  int next_decision() const { return enabled() ? next_ : std::numeric_limits<int>::max(); }
  /// Call it when every active block has next_decision() camera rays per pixel.
  void decide(const Film& film);
  /// Largest error of all blocks; 0 while unknown.
  double worst(const Film& film) const;

 private:
  std::vector<BlockError> errors(const Film& film) const;

  const double target_;
  const std::vector<PixelRect> blocks_;
  std::vector<size_t> active_;
  std::vector<bool> passed_;  // at the last decision, by block
  int next_ = kRaysAtLeast;
};

// Stopping criterion of a denoised render: the error of the denoised image.

/// Decides at numbers of camera rays that depend only on previous errors, so the image depends neither on threads nor
/// on time.
class DenoisedTarget {
 public:
  /// `target`: square root of the relmse that the error bound must meet (DenoisedError).
  DenoisedTarget(double target, int threads) : target_(target), threads_(threads) {}

  bool done() const { return done_; }
  /// Number of camera rays per pixel at the next decision; a pass must not exceed it.
  int next_decision() const { return next_; }
  /// Call it when every pixel has next_decision() camera rays. Throws what denoise() throws.
  void decide(Film& film, const Progress& progress);

 private:
  const double target_;
  const int threads_;
  int next_ = 4;
  bool done_ = false;
};

// Denoised image of a film, and its error.

/// Denoises `film`, which must have pass::kHalves, unless it is already denoised, and stores the result in it as the
/// pass "Denoised". The halves are denoised separately and combined (denoise/denoiser.h). A film with fewer than two
/// camera rays in some pixel is denoised as a whole, and its error is unknown. `threads` 0: all. Throws
/// Error(unsupported) without Open Image Denoise, Error(invalid_argument) if the film has no halves, Error(cancelled).
void denoise(Film& film, int threads, const Progress& progress);

/// Denoised colors only, from all camera rays at once, for interactive viewing: takes a twentieth of the time.
std::vector<float> denoised_colors(const Film& film, int threads, const Progress& progress);

}  // namespace velour
