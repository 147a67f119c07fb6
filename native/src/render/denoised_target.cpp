#include "render/denoised_target.h"

#include <algorithm>
#include <cmath>

#include "render/denoise_film.h"

namespace velour {
namespace {

// Growth factors of the camera rays between decisions; a decision costs as much as about ten of them.
constexpr double kLeastGrowth = 1.25, kMostGrowth = 4;

}  // namespace

void DenoisedTarget::decide(Film& film, const Progress& progress) {
  denoise(film, threads_, progress);
  const std::optional<DenoisedError> error = film.denoised_error();
  const double excess = error ? error->bound() / (target_ * target_) : kMostGrowth;
  done_ = excess <= 1;
  const double rays = next_ * std::clamp(excess, kLeastGrowth, kMostGrowth);
  next_ = 2 * static_cast<int>(std::ceil(rays / 2));  // both halves have the same number
}

}  // namespace velour
