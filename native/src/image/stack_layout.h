// Where the rows of image stacks lie in their file: an OpenEXR file of uncompressed scan lines has its headers, a chunk
// table for each part, then the chunks, a row each, all in order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/image_stack.h"

namespace velour {

/// As OpenEXR stores them: in alphabetical order.
std::vector<std::string> stored_channels(const ImageStack& stack);

class StackLayout {
 public:
  StackLayout() = default;
  /// `headers`: bytes of them.
  StackLayout(std::span<const ImageStack> stacks, uint64_t headers);

  /// Of the file.
  uint64_t bytes() const { return bytes_; }
  /// Where the chunk tables begin.
  uint64_t tables() const { return tables_; }
  /// Where the chunk of row `y` is; of a part's images the rows are counted through, from the top of the first.
  uint64_t chunk(size_t stack, uint64_t y) const { return begin_[stack] + y * step(stack); }
  uint64_t step(size_t stack) const { return head_bytes() + row_bytes_[stack]; }
  uint64_t head_bytes() const { return row_bytes_.size() > 1 ? 12 : 8; }
  /// Before the pixels of a row: the number of the part, where there are several, the row, and the bytes of its pixels.
  void write_head(size_t stack, uint64_t y, uint8_t* chunk) const;
  bool has_head(size_t stack, uint64_t y, const uint8_t* chunk) const;

 private:
  std::array<uint8_t, 12> whole_head(size_t stack, uint64_t y) const;

  std::vector<uint64_t> row_bytes_, begin_;  // of each stack; of its first chunk
  uint64_t tables_ = 0, bytes_ = 0;
};

}  // namespace velour
