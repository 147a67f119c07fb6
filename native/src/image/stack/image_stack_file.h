// Reads single images of image stacks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "image/stack/image_stack.h"

namespace velour {

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
