// Reads parts of a file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "file/descriptor.h"

namespace velour {

/// Keeps the file open. Calls are thread-safe.
class RandomAccessFile {
 public:
  /// Throws Error(io) if `path` cannot be read or is not a regular file.
  explicit RandomAccessFile(std::string path);

  const std::string& path() const { return path_; }
  /// Size in bytes when the file was opened.
  uint64_t size() const { return size_; }

  /// Fills `bytes` with the file's content from `offset` on. Throws Error(bad_data) if the file ends early.
  void read(uint64_t offset, std::span<uint8_t> bytes) const;

 private:
  std::string path_;
  Descriptor fd_;
  uint64_t size_;
};

}  // namespace velour
