// Names as numbers: Friedman and Jones [FJ15], Cryptomatte specification 1.2.0.
#pragma once

#include <cstdint>
#include <string_view>

namespace velour {

/// MurmurHash3_x86_32 of Austin Appleby (public domain), seed 0.
uint32_t murmur_hash(std::string_view name);

/// The bits of the hash of a UTF-8 name as a float. The lowest bit of the exponent is flipped where they would be zero,
/// a subnormal, an infinity or a NaN: the specification's conversion "uint32_to_float32".
float cryptomatte_id(std::string_view name);

}  // namespace velour
