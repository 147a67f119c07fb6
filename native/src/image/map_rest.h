// Predicts the bytes of a map from their neighbors and stores the residuals, which compress better.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// Replaces each byte of `maps` [map][row][column] by its residual, modulo 256, from a prediction by its left and lower
/// neighbors: the median of these two and the plane through them and the neighbor between them [WSS00].
void maps_to_rests(std::span<uint8_t> maps, uint64_t rows, uint64_t columns);

void rests_to_maps(std::span<uint8_t> rests, uint64_t rows, uint64_t columns);

}  // namespace velour
