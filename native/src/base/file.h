// Reads whole files up to a limit, hashes them, and writes files that appear complete or not at all.
#pragma once

#include <unistd.h>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include "base/progress.h"

namespace velour {

/// All bytes of `path`. Throws Error(io) if it cannot be read, Error(bad_data) if it is larger than `limit` bytes.
std::vector<uint8_t> read_file(const std::string& path, uint64_t limit = uint64_t{8} << 30);

/// The first `count` bytes (fewer when the file is shorter).
std::vector<uint8_t> read_file_head(const std::string& path, size_t count);

/// Writes atomically: a killed process leaves the old file or the new one (AtomicFile).
void write_file(const std::string& path, std::span<const uint8_t> bytes);

/// SHA-256 in lower-case hexadecimal.
std::string sha256_hex(std::span<const uint8_t> bytes);

/// SHA-256 of a file, read a megabyte at a time.
std::string sha256_of_file(const std::string& path, const Progress& progress = Progress());

// File descriptors. Internal to base/.

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  /// Closes explicitly, because a full disk may be reported only here. Returns the result of close(2).
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

/// Throws Error(io) with the message "PATH: cannot ACTION: MEANING OF ERRNO `code`."
[[noreturn]] void fail_with_code(const std::string& path, const char* action, int code);

/// Opens `path` for reading and returns its descriptor. Throws Error(io).
int open_for_reading(const std::string& path);

/// Size of an open regular file in bytes. Throws Error(io) for pipes and devices, which have no size to check claims
/// against.
uint64_t regular_size(int fd, const std::string& path);

// Reads parts of a file.

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

// A file that appears complete or not at all.

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
