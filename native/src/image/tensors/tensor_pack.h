// Tensors and texts in one zlib stream, for small files: OpenEXR takes some 450 bytes for the header of a part, and has
// no 8-bit channels.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>
#include "image/tensors/tensor.h"

namespace velour {

/// Maximum number of bytes of a text that remains an attribute, which other programs can read. Longer ones are packed.
constexpr size_t kLongestOpenText = 256;

/// A zlib stream of the size in bytes of a JSON object that lists texts and tensors (32 bits, little-endian), that
/// object, and the tensors' values: residuals of bytes; for halves and floats, all highest bytes, then all
/// next lower ones, and so on. Tensors must pass check_tensor(). Throws Error(invalid_argument) beyond 4 GiB.
std::vector<uint8_t> encode_pack(const TensorFile& file);

struct PackLimits {
  std::function<bool(const std::string& tensor)> takes = {};  // others are skipped; empty: all are read
  uint64_t max_bytes = UINT64_MAX;                            // of all tensors, in memory
};

/// Throws Error(bad_data) that begins with `where`, before it allocates more than the bytes can expand to or than the
/// limits allow.
TensorFile decode_pack(std::span<const uint8_t> bytes, const std::string& where, const PackLimits& limits = {});

// Predicts the bytes of a map from their neighbors and stores the residuals, which compress better.

/// Replaces each byte of `maps` [map][row][column] by its residual, modulo 256, from a prediction by its left and lower
/// neighbors: the median of these two and the plane through them and the neighbor between them [WSS00].
void maps_to_rests(std::span<uint8_t> maps, uint64_t rows, uint64_t columns);

void rests_to_maps(std::span<uint8_t> rests, uint64_t rows, uint64_t columns);

}  // namespace velour
