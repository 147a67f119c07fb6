#include "file/atomic_file.h"

#include <fcntl.h>

#include <cerrno>
#include <random>
#include <system_error>

#include "job/error.h"

namespace velour {
namespace {

constexpr size_t kBuffer = size_t{1} << 20;

/// Where the bytes go: a link's target, so that the link survives. Devices and folders are refused, because the rename
/// would replace a device by a file.
std::filesystem::path write_target(const std::string& path) {
  std::error_code ignored;
  const auto target = std::filesystem::is_symlink(path, ignored) ? std::filesystem::weakly_canonical(path, ignored)
                                                                 : std::filesystem::path(path);
  if (std::filesystem::exists(target, ignored) && !std::filesystem::is_regular_file(target, ignored))
    throw Error(Status::io, path + ": is not a regular file; choose another name.");
  return target;
}

/// A new file beside the target, because renames are atomic within one folder only, and its name. The name is random:
/// processes of other machines and containers, whose ids may be equal, write to the same folder, and what a killed one
/// has left stays. Over a network a new file may be said to exist already: then another name.
int create_beside(const std::filesystem::path& target, const std::string& path, std::string& name) {
  constexpr int kAttempts = 16;
  std::random_device random;
  for (int attempt = 1;; ++attempt) {
    name = target.string() + ".velour-" + std::to_string(random()) + "-" + std::to_string(random());
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) return fd;
    if (errno != EEXIST || attempt == kAttempts) fail_with_code(path, "write", errno);
  }
}

/// Makes the rename itself survive a power cut; a file system that cannot is no reason to fail.
void sync_folder(const std::filesystem::path& target) {
  const auto folder = target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
  const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() >= 0) ::fsync(fd.get());
}

}  // namespace

AtomicFile::AtomicFile(std::string path)
    : path_(std::move(path)), target_(write_target(path_)), fd_(create_beside(target_, path_, temporary_)) {}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicFile::write_through(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(fd_.get(), bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) {
      failed_ = true;
      fail_with_code(path_, "write", errno);
    }
    bytes = bytes.subspan(static_cast<size_t>(put));
    start_ += static_cast<uint64_t>(put);
  }
}

void AtomicFile::flush() {
  std::vector<uint8_t> pending;
  pending.swap(buffer_);
  write_through(pending);
  pending.clear();
  buffer_.swap(pending);  // keeps its memory
}

void AtomicFile::write(std::span<const uint8_t> bytes) {
  if (buffer_.size() + bytes.size() > kBuffer) flush();
  if (bytes.size() > kBuffer) return write_through(bytes);
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void AtomicFile::seek(uint64_t position) {
  flush();
  if (::lseek(fd_.get(), static_cast<off_t>(position), SEEK_SET) < 0) {
    failed_ = true;
    fail_with_code(path_, "write", errno);
  }
  start_ = position;
}

void AtomicFile::commit() {
  if (failed_) throw Error(Status::io, path_ + ": cannot write: an earlier part of it could not be written.");
  flush();
  if (::fsync(fd_.get()) != 0 || fd_.close() != 0) fail_with_code(path_, "write", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail_with_code(path_, "write", errno);
  committed_ = true;
  sync_folder(target_);
}

}  // namespace velour
