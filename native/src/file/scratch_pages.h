// Memory that may be larger than the machine's.
#pragma once

#include <cstdint>
#include <string>

namespace velour {

/// Zeroed pages. Above `limit` bytes they are those of a mapped temporary file in `folder` that has no name, so that a
/// killed process leaves nothing, and leave memory whenever release() is called.
class ScratchPages {
 public:
  /// Throws Error(io) when the file cannot be made, std::bad_alloc when there is no memory.
  ScratchPages(uint64_t bytes, uint64_t limit, const std::string& folder);
  ~ScratchPages();
  ScratchPages(const ScratchPages&) = delete;
  ScratchPages& operator=(const ScratchPages&) = delete;

  /// Null where there are no bytes.
  void* data() const { return data_; }
  bool in_file() const { return in_file_; }
  /// Takes those of a file out of the process's memory; they are read again when used. Thread-safe.
  void release() const;

 private:
  const uint64_t bytes_;
  const bool in_file_;
  void* data_ = nullptr;
};

}  // namespace velour
