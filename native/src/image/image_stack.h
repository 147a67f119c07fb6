// Stacks of images of the same size in a multi-part OpenEXR file of uncompressed scan lines, from which single images
// can be read.
//
// Uncompressed, because the content is mostly Monte Carlo noise in half floats, of which ZIP saves 28 % (ZIPS 20 %) at
// some 30 MB/s per core, and because uncompressed rows have known offsets: an image is read in one piece, and a file
// can be checked by its size, its headers and its chunk tables alone.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "job/progress.h"

namespace velour {

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

}  // namespace velour
