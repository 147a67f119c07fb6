// The structure of an OpenEXR file, checked byte by byte before OpenEXR itself sees it.
//
// OpenEXR allocates what a header claims, and its only limits (Header::setMaxImageSize) are global to the process,
// which may be Blender's. So the claims are compared with the bytes here: afterwards OpenEXR opens nothing but scan
// line parts of floats, half floats or integers, lossless, whose chunks lie inside the file and are large enough for
// their pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace velour {

struct ExrPart {
  std::string name;    // empty in a single-part file without a name
  std::string shape;   // text of "velour.shape"; empty: not a tensor
  std::string coding;  // text of "velour.coding"
  uint64_t width = 0, height = 0;
  std::vector<std::string> channels;  // full resolution, in file order
  uint64_t value_bytes = 4;           // of all channels: 4 (float) or 2 (half)
  bool integers = false;              // 32 bits, of all channels, in place of floats
  bool compressed = false;

  uint64_t value_count() const { return width * height * channels.size(); }
  uint64_t row_bytes() const { return width * channels.size() * value_bytes; }
};

/// Throws Error(bad_data, unsupported) with `name`, the part and the field at fault.
std::vector<ExrPart> scan_exr(std::span<const uint8_t> bytes, const std::string& name);

struct ExrHeaders {
  std::vector<ExrPart> parts;
  uint64_t bytes = 0;  // where they end and the chunk tables begin
};

/// The headers alone: `head` is the beginning of a file and must hold them whole. Nothing is said of chunks.
ExrHeaders scan_exr_headers(std::span<const uint8_t> head, const std::string& name);

}  // namespace velour
