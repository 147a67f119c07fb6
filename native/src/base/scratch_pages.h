// Temporary memory that may exceed the machine's.
#pragma once

#include <cstdint>
#include <string>

namespace velour {

/// Zeroed pages. Above `limit` bytes they are backed by an unnamed temporary file in `folder`, so that a killed process
/// leaves nothing behind, and release() can evict them from memory.
class ScratchPages {
 public:
  /// Throws Error(io) if the file cannot be created, std::bad_alloc if there is no memory.
  ScratchPages(uint64_t bytes, uint64_t limit, const std::string& folder);
  ~ScratchPages();
  ScratchPages(const ScratchPages&) = delete;
  ScratchPages& operator=(const ScratchPages&) = delete;

  /// Null for 0 bytes.
  void* data() const { return data_; }
  bool in_file() const { return in_file_; }
  /// Evicts file-backed pages from the process's memory; they are read back when used. Thread-safe.
  void release() const;

 private:
  const uint64_t bytes_;
  const bool in_file_;
  void* data_ = nullptr;
};

}  // namespace velour
