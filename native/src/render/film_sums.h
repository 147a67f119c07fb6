// A film's sums as plain numbers: what one run leaves to the next, or one machine to another.
#pragma once

#include <cstddef>
#include <span>

#include "render/film.h"

namespace velour {

/// Floats a pixel: those of PixelSum, and what the film's layout keeps.
size_t sums_per_pixel(const Film& film);

/// All pixels from the bottom row on, sums_per_pixel() each. Exact: a film of nothing to which they are added has the
/// same bits. Throws Error(invalid_argument) where `sums` has another size.
void read_sums(const Film& film, std::span<float> sums);

/// Adds the sums of camera rays that come after those of `film`, which has the same passes. Throws Error(bad_data)
/// where they are none that read_sums() has written; `film` is unchanged then.
void add_sums(std::span<const float> sums, Film& film);

}  // namespace velour
