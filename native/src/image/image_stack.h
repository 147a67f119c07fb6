// Stacks of images from which single ones are read.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>
#include "base/file.h"
#include "base/progress.h"

namespace velour {

// Stacks of images of the same size in a multi-part OpenEXR file of uncompressed scan lines, from which single images
// can be read.
//
// Uncompressed, because the content is mostly Monte Carlo noise in half floats, of which ZIP saves 28 % (ZIPS 20 %) at
// some 30 MB/s per core, and because uncompressed rows have known offsets: an image is read in one piece, and a file
// can be checked by its size, its headers and its chunk tables alone.

enum class StackValue : uint8_t { half, float32 };

/// One part: images below one another, with channel Y or R, G, B. In memory, an image is [row][column][channel] with
/// row 0 at the bottom; in the file, its top row comes first, so that viewers show it upright.
struct ImageStack {
  std::string name;
  StackValue value = StackValue::half;
  uint64_t channels = 1;  // or 3
  uint64_t width = 0, height = 0, images = 0;

  uint64_t value_bytes() const { return value == StackValue::half ? 2 : 4; }
  uint64_t row_bytes() const { return width * channels * value_bytes(); }
  uint64_t image_bytes() const { return height * row_bytes(); }
  bool operator==(const ImageStack&) const = default;
};

/// Header attributes: text by name.
using ImageAttributes = std::map<std::string, std::string>;

/// Writes atomically. `pixels[i]`: all bytes of stacks[i]. Throws Error(io, invalid_argument).
void write_image_stacks(const std::string& path, std::span<const ImageStack> stacks,
                        std::span<const std::span<const uint8_t>> pixels, const ImageAttributes& attributes = {},
                        const Progress& progress = Progress());

// Layout of image stacks in their file: an OpenEXR file of uncompressed scan lines consists of the headers, a chunk
// table for each part, then the chunks of one row each, all in order.

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

// Reads single images of image stacks.

/// An open file of image stacks. Calls are thread-safe.
class ImageStackFile {
 public:
  /// Throws Error(bad_data) unless the file's headers and size match exactly these stacks.
  ImageStackFile(const std::string& path, std::vector<ImageStack> stacks);

  /// Reads images [first, first + pixels.size() / image_bytes()) of stacks[stack].
  void read(size_t stack, uint64_t first, std::span<uint8_t> pixels) const;
  /// Throws Error(bad_data) unless the chunk tables, with which other programs find rows, are correct. Nothing here
  /// uses them, so one check per file is enough.
  void check_chunk_tables() const;
  uint64_t bytes() const { return file_.size(); }

 private:
  void check_headers(std::span<const uint8_t> head);
  void read_image(size_t index, uint64_t image, std::span<uint8_t> chunks, std::span<uint8_t> pixels) const;

  RandomAccessFile file_;
  std::vector<ImageStack> stacks_;
  StackLayout layout_;
};

}  // namespace velour
