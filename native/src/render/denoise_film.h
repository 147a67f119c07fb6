// Denoised image of a film, and its error.
#pragma once

#include "job/progress.h"
#include "render/film.h"

namespace velour {

/// Denoises `film`, which must have pass::kHalves, unless it is already denoised, and stores the result in it as the
/// pass "Denoised". The halves are denoised separately and combined (denoise/halves.h). A film with fewer than two
/// camera rays in some pixel is denoised as a whole, and its error is unknown. `threads` 0: all. Throws
/// Error(unsupported) without Open Image Denoise, Error(invalid_argument) if the film has no halves, Error(cancelled).
void denoise(Film& film, int threads, const Progress& progress);

/// Denoised colors only, from all camera rays at once, for interactive viewing: takes a twentieth of the time.
std::vector<float> denoised_colors(const Film& film, int threads, const Progress& progress);

}  // namespace velour
