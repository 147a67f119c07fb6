// Layout of image stacks in their file: an OpenEXR file of uncompressed scan lines consists of the headers, a chunk
// table for each part, then the chunks of one row each, all in order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/image_stack.h"

namespace velour {

/// Names of the channels in alphabetical order, as OpenEXR stores them.
std::vector<std::string> stored_channels(const ImageStack& stack);

class StackLayout {
 public:
  StackLayout() = default;
  /// `headers`: size of the headers in bytes.
  StackLayout(std::span<const ImageStack> stacks, uint64_t headers);

  /// Size of the file in bytes.
  uint64_t bytes() const { return bytes_; }
  /// Offset of the chunk tables.
  uint64_t tables() const { return tables_; }
  /// Offset of the chunk of row `y`, counted through all images of the part from the top of the first.
  uint64_t chunk(size_t stack, uint64_t y) const { return begin_[stack] + y * step(stack); }
  uint64_t step(size_t stack) const { return head_bytes() + row_bytes_[stack]; }
  uint64_t head_bytes() const { return row_bytes_.size() > 1 ? 12 : 8; }
  /// Writes what precedes the pixels of a row: the part's number (in files of several parts), the row, and its size in
  /// bytes.
  void write_head(size_t stack, uint64_t y, uint8_t* chunk) const;
  bool has_head(size_t stack, uint64_t y, const uint8_t* chunk) const;

 private:
  std::array<uint8_t, 12> whole_head(size_t stack, uint64_t y) const;

  std::vector<uint64_t> row_bytes_, begin_;  // bytes per row and offset of the first chunk of each stack
  uint64_t tables_ = 0, bytes_ = 0;
};

}  // namespace velour
