#include "file/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "job/error.h"

namespace velour {
namespace {

[[noreturn]] void fail(const std::string& path, const char* action, int code) {
  throw Error(Status::io, path + ": cannot " + action + ": " + std::generic_category().message(code) + ".");
}

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

/// Size of the open regular file. A pipe or a device has no size to check claims against, so it is refused.
uint64_t regular_size(int fd, const std::string& path) {
  struct stat info {};
  if (::fstat(fd, &info) != 0) fail(path, "read", errno);
  if (!S_ISREG(info.st_mode)) throw Error(Status::io, path + ": is not a regular file; give a file.");
  return static_cast<uint64_t>(info.st_size);
}

/// Reads up to `bytes.size()` bytes and shrinks to what the file held.
void read_all(int fd, const std::string& path, std::vector<uint8_t>& bytes) {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, "read", errno);
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  bytes.resize(done);
}

void write_all(int fd, const std::string& path, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(fd, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) fail(path, "write", errno);
    bytes = bytes.subspan(static_cast<size_t>(put));
  }
}

/// Where the bytes go: a link's target, so that the link survives. Devices and folders are refused, because the rename
/// below would replace a device by a file.
std::filesystem::path write_target(const std::string& path) {
  std::error_code ignored;
  const auto target = std::filesystem::is_symlink(path, ignored) ? std::filesystem::weakly_canonical(path, ignored)
                                                                 : std::filesystem::path(path);
  if (std::filesystem::exists(target, ignored) && !std::filesystem::is_regular_file(target, ignored))
    throw Error(Status::io, path + ": is not a regular file; choose another name.");
  return target;
}

/// A name beside the target that no other process or thread uses: renames are atomic within one folder only.
std::string temporary_name(const std::filesystem::path& target) {
  static std::atomic<uint64_t> counter{0};
  return target.string() + ".velour-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
}

/// Makes the rename itself survive a power cut; a file system that cannot is no reason to fail.
void sync_folder(const std::filesystem::path& target) {
  const auto folder = target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
  const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() >= 0) ::fsync(fd.get());
}

void write_synced(const std::string& name, const std::string& path, std::span<const uint8_t> bytes) {
  Descriptor fd(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (fd.get() < 0) fail(path, "write", errno);
  write_all(fd.get(), path, bytes);
  if (::fsync(fd.get()) != 0 || fd.close() != 0) fail(path, "write", errno);
}

}  // namespace

std::vector<uint8_t> read_file(const std::string& path, uint64_t limit) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() < 0) fail(path, "read", errno);
  const uint64_t size = regular_size(fd.get(), path);
  if (size > limit)
    throw Error(Status::bad_data, path + ": holds " + std::to_string(size) + " bytes, more than the limit of " +
                                      std::to_string(limit) + "; is it the right file?");
  std::vector<uint8_t> bytes(size);
  read_all(fd.get(), path, bytes);
  return bytes;
}

std::vector<uint8_t> read_file_head(const std::string& path, size_t count) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() < 0) fail(path, "read", errno);
  std::vector<uint8_t> bytes(std::min<uint64_t>(count, regular_size(fd.get(), path)));
  read_all(fd.get(), path, bytes);
  return bytes;
}

void write_file(const std::string& path, std::span<const uint8_t> bytes) {
  const auto target = write_target(path);
  const std::string temporary = temporary_name(target);
  try {
    write_synced(temporary, path, bytes);
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(path, "write", errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  sync_folder(target);
}

}  // namespace velour
