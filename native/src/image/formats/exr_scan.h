// Checks the structure of an OpenEXR file byte by byte before OpenEXR itself sees it.
//
// OpenEXR allocates what a header claims, and its only limits (Header::setMaxImageSize) are global to the process,
// which may be Blender's. So the claims are compared with the bytes here: after the scan, OpenEXR only opens lossless
// scan line parts of floats, half floats or integers whose chunks lie inside the file and are large enough for their
// pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace velour {

struct ExrPart {
  std::string name;    // empty in a single-part file without a name
  std::string shape;   // attribute "velour.shape"; empty: not a tensor
  std::string coding;  // attribute "velour.coding"
  uint64_t width = 0, height = 0;
  std::vector<std::string> channels;  // full resolution, in file order
  uint64_t value_bytes = 4;           // in all channels: 4 (float or integer) or 2 (half)
  bool integers = false;              // 32-bit integers in all channels instead of floats
  bool compressed = false;

  uint64_t value_count() const { return width * height * channels.size(); }
  uint64_t row_bytes() const { return width * channels.size() * value_bytes; }
};

/// Scans a whole file. Throws Error(bad_data, unsupported) with `name`, the part and the field at fault.
std::vector<ExrPart> scan_exr(std::span<const uint8_t> bytes, const std::string& name);

struct ExrHeaders {
  std::vector<ExrPart> parts;
  uint64_t bytes = 0;  // size of the headers; the chunk tables begin here
};

/// Scans the headers only: `head` is the beginning of a file and must contain all of them. Does not check chunks.
ExrHeaders scan_exr_headers(std::span<const uint8_t> head, const std::string& name);

}  // namespace velour
