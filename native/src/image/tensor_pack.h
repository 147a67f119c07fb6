// Tensors and texts in one stream of zlib, for files that are to be small: OpenEXR takes some 450 bytes for the header
// of a part, and has no bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/tensor.h"

namespace velour {

/// Texts longer than this many bytes go into packs; shorter ones remain attributes that other programs read.
constexpr size_t kLongestOpenText = 256;

/// A stream of zlib: the number of bytes of a JSON object that lists texts and tensors (32 bits, little-endian), that
/// object, and the tensors' values: rests of bytes (map_rest.h); of halves and floats all highest bytes, then all of
/// the next lower ones. Tensors as check_tensor wants them. Throws Error(invalid_argument) beyond 4 GiB.
std::vector<uint8_t> encode_pack(const TensorFile& file);

struct PackLimits {
  std::function<bool(const std::string& tensor)> takes = {};  // others are skipped; empty: all are taken
  uint64_t max_bytes = UINT64_MAX;                            // of all tensors, in memory
};

/// Throws Error(bad_data) that begins with `where`, before it takes memory for what the bytes cannot stand for, or for
/// more than the limits.
TensorFile decode_pack(std::span<const uint8_t> bytes, const std::string& where, const PackLimits& limits = {});

}  // namespace velour
