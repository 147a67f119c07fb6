// The picture of a film without noise, and its error.
#pragma once

#include "job/progress.h"
#include "render/film.h"

namespace velour {

/// Denoises what `film`, which has pass::kHalves, holds, unless it is denoised, and keeps it there: the pass
/// "Denoised". Its halves are denoised each by itself and joined (denoise/halves.h). A film in which a pixel has less
/// than two camera rays is denoised as a whole, and its error unknown. `threads` 0: all. Throws Error(unsupported)
/// where there is no Open Image Denoise, Error(invalid_argument) where the film has no halves, Error(cancelled).
void denoise(Film& film, int threads, const Progress& progress);

/// The colors alone, of all camera rays at once, for somebody who watches: a twentieth of the time.
std::vector<float> denoised_colors(const Film& film, int threads, const Progress& progress);

}  // namespace velour
