#include "file/file.h"

#include <algorithm>
#include <cerrno>

#include "file/atomic_file.h"
#include "file/descriptor.h"
#include "job/error.h"

namespace velour {
namespace {

/// Reads up to `bytes.size()` bytes and shrinks `bytes` to the number that was read.
void read_all(int fd, const std::string& path, std::vector<uint8_t>& bytes) {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_with_code(path, "read", errno);
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  bytes.resize(done);
}

}  // namespace

std::vector<uint8_t> read_file(const std::string& path, uint64_t limit) {
  const Descriptor fd(open_for_reading(path));
  const uint64_t size = regular_size(fd.get(), path);
  if (size > limit)
    throw Error(Status::bad_data, path + ": has " + std::to_string(size) + " bytes, more than the limit of " +
                                      std::to_string(limit) + ". Check that it is the right file.");
  std::vector<uint8_t> bytes(size);
  read_all(fd.get(), path, bytes);
  return bytes;
}

std::vector<uint8_t> read_file_head(const std::string& path, size_t count) {
  const Descriptor fd(open_for_reading(path));
  std::vector<uint8_t> bytes(std::min<uint64_t>(count, regular_size(fd.get(), path)));
  read_all(fd.get(), path, bytes);
  return bytes;
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace velour
