// A file that appears complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"

namespace velour {

/// Written beside its path under a temporary name, then flushed and renamed by commit(): a killed process leaves the
/// old file or the new one. Without a commit nothing remains. The next process that writes to the same folder removes
/// the temporary files of killed processes, which are those that nobody locks. A failed write is remembered, so that
/// commit() throws its reason even if a caller has swallowed the exception.
class AtomicFile {
 public:
  /// Throws Error(io).
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const uint8_t> bytes);
  void seek(uint64_t position);
  uint64_t position() const { return start_ + buffer_.size(); }
  void commit();

 private:
  void flush();
  void write_through(std::span<const uint8_t> bytes);

  std::string path_;
  std::filesystem::path target_;
  std::string temporary_;
  Descriptor fd_;
  std::vector<uint8_t> buffer_;
  uint64_t start_ = 0;  // file position of the buffer
  int failure_ = 0;     // errno of the first write that failed
  bool committed_ = false;
};

}  // namespace velour
