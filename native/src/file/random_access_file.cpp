#include "file/random_access_file.h"

#include <cerrno>

#include "job/error.h"

namespace velour {

RandomAccessFile::RandomAccessFile(std::string path)
    : path_(std::move(path)), fd_(open_for_reading(path_)), size_(regular_size(fd_.get(), path_)) {}

void RandomAccessFile::read(uint64_t offset, std::span<uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_with_code(path_, "read", errno);
    if (got == 0) {
      throw Error(Status::bad_data,
                  path_ + ": ends at byte " + std::to_string(offset) + "; it was truncated while it was being read.");
    }
    bytes = bytes.subspan(static_cast<size_t>(got));
    offset += static_cast<uint64_t>(got);
  }
}

}  // namespace velour
