// Stacks of images of one size in one file, read image by image without the rest: OpenEXR of several parts, scan lines,
// uncompressed.
//
// Uncompressed, because what is stored here is mostly Monte Carlo noise in half floats, of which ZIP saves 28 % (ZIPS
// 20 %) at some 30 MB/s and core, and because uncompressed rows lie at known places: reading an image is one read of
// its bytes, and a file can be checked by its size, its headers and its chunk tables alone.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "file/random_access_file.h"
#include "job/progress.h"

namespace velour {

enum class StackValue : uint8_t { half, float32 };

/// One part: images one below the other, channel Y or R, G, B. In memory an image is [row][column][channel] with row 0
/// at the bottom, in the file its top row comes first, so that viewers show it upright.
struct ImageStack {
  std::string name;
  StackValue value = StackValue::half;
  uint64_t channels = 1;  // or 3
  uint64_t width = 0, height = 0, images = 0;

  uint64_t row_bytes() const { return width * channels * (value == StackValue::half ? 2 : 4); }
  uint64_t image_bytes() const { return height * row_bytes(); }
  bool operator==(const ImageStack&) const = default;
};

/// Names and texts of the header.
using ImageAttributes = std::map<std::string, std::string>;

/// Atomic. `pixels[i]`: all bytes of stacks[i]. Throws Error(io, invalid_argument).
void write_image_stacks(const std::string& path, std::span<const ImageStack> stacks,
                        std::span<const std::span<const uint8_t>> pixels, const ImageAttributes& attributes = {},
                        const Progress& progress = Progress());

/// An open file of stacks. Calls are thread-safe.
class ImageStackFile {
 public:
  /// Throws Error(bad_data) unless the file's headers and size are those of exactly these stacks.
  ImageStackFile(const std::string& path, std::vector<ImageStack> stacks);

  /// Images [first, first + pixels.size() / image_bytes()) of stacks[stack].
  void read(size_t stack, uint64_t first, std::span<uint8_t> pixels) const;
  /// Throws Error(bad_data) unless the chunk tables, by which other programs find rows, say what is true. Nothing here
  /// needs them; once, when a file is met, is enough.
  void check_chunk_tables() const;
  uint64_t bytes() const { return file_.size(); }

 private:
  void check_headers(std::span<const uint8_t> head);
  void read_image(size_t index, uint64_t image, std::span<uint8_t> chunks, std::span<uint8_t> pixels) const;

  RandomAccessFile file_;
  std::vector<ImageStack> stacks_;
  uint64_t tables_ = 0;          // where the chunk tables begin
  std::vector<uint64_t> begin_;  // of each stack's first chunk
};

}  // namespace velour
