// Stopping criterion of a denoised render: the error of the denoised image.
#pragma once

#include "base/progress.h"
#include "render/film/film.h"

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

// Denoised image of a film, and its error.

/// Denoises `film`, which must have pass::kHalves, unless it is already denoised, and stores the result in it as the
/// pass "Denoised". The halves are denoised separately and combined (denoise/halves.h). A film with fewer than two
/// camera rays in some pixel is denoised as a whole, and its error is unknown. `threads` 0: all. Throws
/// Error(unsupported) without Open Image Denoise, Error(invalid_argument) if the film has no halves, Error(cancelled).
void denoise(Film& film, int threads, const Progress& progress);

/// Denoised colors only, from all camera rays at once, for interactive viewing: takes a twentieth of the time.
std::vector<float> denoised_colors(const Film& film, int threads, const Progress& progress);

}  // namespace velour
