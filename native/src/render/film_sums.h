// A film's sums as plain floats, passed from one run or machine to another.
#pragma once

#include <cstddef>
#include <span>

#include "render/film.h"

namespace velour {

/// Floats per pixel: those of PixelSum and of the film's layout.
size_t sums_per_pixel(const Film& film);

/// Reads all pixels from the bottom row up, sums_per_pixel() each. Exact: added to an empty film, they reproduce the
/// same bits. Throws Error(invalid_argument) if `sums` has the wrong size.
void read_sums(const Film& film, std::span<float> sums);

/// Adds the sums of the camera rays that follow those of `film`, which has the same passes. Throws
/// Error(invalid_argument) if `sums` has the wrong size, Error(bad_data) if it was not written by read_sums(); `film`
/// is unchanged then.
void add_sums(std::span<const float> sums, Film& film);

}  // namespace velour
