// Cryptomatte ids of names: Friedman and Jones [FJ15], Cryptomatte specification 1.2.0.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace velour {

/// MurmurHash3_x86_32 of Austin Appleby (public domain), seed 0.
uint32_t murmur_hash(std::string_view name);

/// The hash of a UTF-8 name, reinterpreted as a float. The lowest bit of the exponent is flipped where the float would
/// be zero, subnormal, infinite or NaN: the specification's conversion "uint32_to_float32".
float cryptomatte_id(std::string_view name);

// Coverage of a pixel by each of its ids.

/// Floats per pixel for its `ranks` heaviest ids: a few ids more than are shown, because ids that come early need not
/// be heavy in the end.
constexpr int floats_of_ids(int ranks) { return 2 * (ranks + 2); }

/// Adds `weight` to that of `id` in `slots`, which holds (id, weight) pairs; 0 is no id. Drops the id if there is no
/// room.
void add_id(float id, float weight, std::span<float> slots);

/// Writes the ids of ranks `first` and `first` + 1 by weight, heaviest first (ties: smaller id first), each with its
/// weight times `scale`; 0 where there are no more.
void write_ids(std::span<const float> slots, int first, float scale, float out[4]);

}  // namespace velour
