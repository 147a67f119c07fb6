// Descriptors of open files. Internal to file/.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>

namespace velour {

/// Owns a descriptor; closing is the one thing that a destructor may do to it.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  /// Explicit close, because a full disk may be reported only here.
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

/// Throws Error(io): "PATH: cannot ACTION: what errno `code` means."
[[noreturn]] void fail_with_code(const std::string& path, const char* action, int code);

/// A descriptor of `path` for reading; throws Error(io).
int open_for_reading(const std::string& path);

/// Size of the open regular file. A pipe or a device has no size to check claims against, so it is refused.
uint64_t regular_size(int fd, const std::string& path);

}  // namespace velour
