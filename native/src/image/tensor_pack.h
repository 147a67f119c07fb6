// Tensors and texts in one zlib stream, for small files: OpenEXR takes some 450 bytes for the header of a part, and has
// no 8-bit channels.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/tensor.h"

namespace velour {

/// Maximum number of bytes of a text that remains an attribute, which other programs can read. Longer ones are packed.
constexpr size_t kLongestOpenText = 256;

/// A zlib stream of the size in bytes of a JSON object that lists texts and tensors (32 bits, little-endian), that
/// object, and the tensors' values: residuals of bytes (map_rest.h); for halves and floats, all highest bytes, then all
/// next lower ones, and so on. Tensors must pass check_tensor(). Throws Error(invalid_argument) beyond 4 GiB.
std::vector<uint8_t> encode_pack(const TensorFile& file);

struct PackLimits {
  std::function<bool(const std::string& tensor)> takes = {};  // others are skipped; empty: all are read
  uint64_t max_bytes = UINT64_MAX;                            // of all tensors, in memory
};

/// Throws Error(bad_data) that begins with `where`, before it allocates more than the bytes can expand to or than the
/// limits allow.
TensorFile decode_pack(std::span<const uint8_t> bytes, const std::string& where, const PackLimits& limits = {});

}  // namespace velour
