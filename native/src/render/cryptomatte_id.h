// Cryptomatte ids of names: Friedman and Jones [FJ15], Cryptomatte specification 1.2.0.
#pragma once

#include <cstdint>
#include <string_view>

namespace velour {

/// MurmurHash3_x86_32 of Austin Appleby (public domain), seed 0.
uint32_t murmur_hash(std::string_view name);

/// The hash of a UTF-8 name, reinterpreted as a float. The lowest bit of the exponent is flipped where the float would
/// be zero, subnormal, infinite or NaN: the specification's conversion "uint32_to_float32".
float cryptomatte_id(std::string_view name);

}  // namespace velour
