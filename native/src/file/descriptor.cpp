#include "file/descriptor.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "job/error.h"

namespace velour {

void fail_with_code(const std::string& path, const char* action, int code) {
  throw Error(Status::io, path + ": cannot " + action + ": " + std::generic_category().message(code) + ".");
}

int open_for_reading(const std::string& path) {
  // Non-blocking: opening a pipe would otherwise wait for its writer.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) fail_with_code(path, "read", errno);
  return fd;
}

uint64_t regular_size(int fd, const std::string& path) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) fail_with_code(path, "read", errno);
  if (!S_ISREG(info.st_mode)) throw Error(Status::io, path + ": is not a regular file; choose a file.");
  return static_cast<uint64_t>(info.st_size);
}

}  // namespace velour
