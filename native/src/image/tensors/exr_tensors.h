// Named tensors in a multi-part OpenEXR file, the container of models and of Velour's own tables.
//
// A tensor is a part with one channel "Y": its last dimension is the width, the others flattened are the height, and
// the attribute "velour.shape" holds the shape. A last dimension of three is stored as channels R, G, B instead, so
// that viewers show it in color. The first part is a tensor that covers all others (tensor_pack.h), if there is one:
// Blender allocates a buffer for the first part and reads all parts into it. Parts wider or higher than the first are
// not for viewers: their channels are "value", or "value_x", "value_y", "value_z". Packed files have two parts: a pack
// (tensor_pack.h) as integers in channel "value", with the attribute "velour.coding" "pack", and the smallest tensor
// that is not of bytes. Readers accept parts in any order.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/tensors/tensor.h"

namespace velour {

/// The bytes of the file. Deterministic: the same content gives the same bytes.
std::vector<uint8_t> encode_tensors(const TensorFile& file);

/// Limits for reading untrusted files.
struct TensorLimits {
  /// Prefixes of the names of known tensors; others are skipped unread. Empty: all are read.
  std::vector<std::string_view> known = {};
  /// Maximum memory of all tensors together, in bytes. DEFLATE expands a byte to up to 1032, and packs apply it twice.
  uint64_t max_bytes = UINT64_MAX;
};

/// Usual bound on the decoded bytes of a file of `file_bytes`: measured data compress tenfold at most, and small files
/// of constant values are allowed.
inline uint64_t usual_max_bytes(uint64_t file_bytes) {
  constexpr uint64_t kAlways = uint64_t{256} << 20, kTimes = 200;
  return kAlways + kTimes * file_bytes;
}

/// Checks every shape against the part's data window, the byte count and the limits before allocating. `name`: for
/// error messages.
TensorFile decode_tensors(std::span<const uint8_t> bytes, const std::string& name, const TensorLimits& limits = {});

/// True for bytes that begin like an OpenEXR file.
bool looks_like_exr(std::span<const uint8_t> head);

}  // namespace velour
