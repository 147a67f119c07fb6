// Stopping criterion of a denoised render: the error of the denoised image.
#pragma once

#include "job/progress.h"
#include "render/film.h"

namespace velour {

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

}  // namespace velour
