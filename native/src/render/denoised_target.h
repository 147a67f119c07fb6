// Where a render may stop whose picture is denoised: judged by the error of the denoised picture.
#pragma once

#include "job/progress.h"
#include "render/film.h"

namespace velour {

/// Decides at numbers of camera rays that follow from the errors before, so the picture depends neither on threads nor
/// on time.
class DenoisedTarget {
 public:
  /// `target`: root of the relmse that the bound of the error must meet (DenoisedError).
  DenoisedTarget(double target, int threads) : target_(target), threads_(threads) {}

  bool done() const { return done_; }
  /// Number of camera rays a pixel at which the next decision falls; a pass must not go beyond it.
  int next_decision() const { return next_; }
  /// To be called when every pixel has next_decision() camera rays. Throws what denoise() throws.
  void decide(Film& film, const Progress& progress);

 private:
  const double target_;
  const int threads_;
  int next_ = 4;
  bool done_ = false;
};

}  // namespace velour
