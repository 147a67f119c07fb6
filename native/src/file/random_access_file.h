// A file that is read in parts.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "file/descriptor.h"

namespace velour {

/// Holds the file open. Calls are thread-safe.
class RandomAccessFile {
 public:
  /// Throws Error(io) when `path` cannot be read or is not a regular file.
  explicit RandomAccessFile(std::string path);

  const std::string& path() const { return path_; }
  /// Bytes when it was opened.
  uint64_t size() const { return size_; }

  /// Fills `bytes` from `offset` on; throws Error(bad_data) when the file ends before.
  void read(uint64_t offset, std::span<uint8_t> bytes) const;

 private:
  std::string path_;
  Descriptor fd_;
  uint64_t size_;
};

}  // namespace velour
