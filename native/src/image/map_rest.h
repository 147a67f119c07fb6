// What neighbours do not tell of the bytes of a map.
#pragma once

#include <cstdint>
#include <span>

namespace velour {

/// [map][row][column], in place: what is left of each byte, modulo 256, beside a guess from its neighbours on the left
/// and below: the median of the two and the plane through both and the one between them [WSS00].
void maps_to_rests(std::span<uint8_t> maps, uint64_t rows, uint64_t columns);

void rests_to_maps(std::span<uint8_t> rests, uint64_t rows, uint64_t columns);

}  // namespace velour
