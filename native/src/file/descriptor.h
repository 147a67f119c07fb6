// File descriptors. Internal to file/.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>

namespace velour {

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

}  // namespace velour
