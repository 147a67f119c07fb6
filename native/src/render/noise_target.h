// Where a render may stop: the error of each block of pixels, judged from the film alone.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "render/film.h"

namespace velour {

/// Cuts a picture into blocks of about 16 x 16 pixels, none much smaller: they are the tiles of the work too.
std::vector<PixelRect> blocks_of(const PixelRect& picture);

/// Estimated mean over the pixels of the variance of their luminance, and mean of their luminance.
struct BlockError {
  double variance = 0, luminance = 0;
  bool known = false;  // every pixel has at least one camera ray in each half

  /// sqrt(variance) relative to sqrt(L_b^2 + 0.01 L^2), L the mean luminance of the picture: as in relmse, a black
  /// block is not asked for more than the eye sees.
  double relative_to(double picture_luminance) const;
};
BlockError block_error(std::span<const PixelSum> pixels);

/// Which blocks still need camera rays. Decides at fixed numbers of camera rays, so the picture depends neither on
/// threads nor on how passes are cut. A block is done when its error has been at most the target at two successive
/// decisions, the first of which comes after kRaysAtLeast camera rays; so one lucky estimate before a firefly was seen
/// does not suffice.
class NoiseTarget {
 public:
  static constexpr int kRaysAtLeast = 8;

  /// `target` 0: no block is ever done.
  NoiseTarget(double target, std::vector<PixelRect> blocks);

  bool enabled() const { return target_ > 0.0; }
  std::span<const PixelRect> blocks() const { return blocks_; }
  /// Of the blocks that are not done.
  const std::vector<size_t>& active() const { return active_; }
  /// Number of camera rays a pixel at which the next decision falls; a pass must not go beyond it.
  int next_decision() const { return enabled() ? next_ : std::numeric_limits<int>::max(); }
  /// To be called when every active block has next_decision() camera rays a pixel.
  void decide(const Film& film);
  /// Largest error of all blocks; 0 while unknown.
  double worst(const Film& film) const;

 private:
  std::vector<BlockError> errors(const Film& film) const;

  const double target_;
  const std::vector<PixelRect> blocks_;
  std::vector<size_t> active_;
  std::vector<bool> passed_;  // the last decision, by block
  int next_ = kRaysAtLeast;
};

}  // namespace velour
