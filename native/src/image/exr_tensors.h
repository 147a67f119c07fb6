// Named tensors in the bytes of a multi-part OpenEXR file: the container of models and of Velour's own tables.
//
// In the file a tensor is one part with one channel "Y": its last dimension is the width, the others flattened are the
// height, and the attribute "velour.shape" holds the shape. Three-component last dimensions are stored as channels R,
// G, B instead, so that a viewer shows them in colour. The first part is a tensor that covers all others
// (tensor_pixels.h), where there is one: Blender makes room for the first part only, and reads all of them there. Parts
// wider or higher than the first are not for viewers: their channels are "value", or "value_x", "value_y", "value_z".
// Packed files have two parts: a pack (tensor_pack.h) as integers of channel "value", whose attribute "velour.coding"
// is "pack", and the smallest tensor that is not of bytes. Readers take parts in any order.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/tensor.h"

namespace velour {

/// The bytes of the file; deterministic: the same content gives the same bytes.
std::vector<uint8_t> encode_tensors(const TensorFile& file);

/// What a reader takes of a file that anybody may have made.
struct TensorLimits {
  /// How the names of the tensors begin that it knows; others are skipped unread. Empty: all are taken.
  std::vector<std::string_view> known = {};
  /// Upper bound on the memory of all tensors together. DEFLATE expands a byte to 1032, and a pack twice.
  uint64_t max_bytes = UINT64_MAX;
};

/// Usual bound on the decoded bytes of a file of `file_bytes`: measured data are compressed tenfold at the most, and
/// small files of constant values are let through.
inline uint64_t usual_max_bytes(uint64_t file_bytes) {
  constexpr uint64_t kAlways = uint64_t{256} << 20, kTimes = 200;
  return kAlways + kTimes * file_bytes;
}

/// Checks every shape against the part's data window, the byte count and the limits before allocating. `name` appears
/// in errors.
TensorFile decode_tensors(std::span<const uint8_t> bytes, const std::string& name, const TensorLimits& limits = {});

/// True for bytes that begin like an OpenEXR file.
bool looks_like_exr(std::span<const uint8_t> head);

}  // namespace velour
