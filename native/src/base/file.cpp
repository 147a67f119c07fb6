#include "base/file.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <algorithm>
#include <cerrno>
#include <ctime>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <string_view>
#include <system_error>

#include "base/error.h"

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

namespace {

class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(std::span<const uint8_t> bytes) {
    require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest, &size) == 1);
    static constexpr char kHex[] = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
      text += kHex[digest[i] >> 4];
      text += kHex[digest[i] & 15];
    }
    return text;
  }

 private:
  static void require(bool works) {
    if (!works) throw Error(Status::unknown, "SHA-256 is not available in this build of OpenSSL.");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_hex(std::span<const uint8_t> bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.hex();
}

std::string sha256_of_file(const std::string& path, const Progress& progress) {
  const RandomAccessFile file(path);
  std::vector<uint8_t> piece(size_t{1} << 20);
  Digest digest;
  for (uint64_t done = 0; done < file.size(); done += piece.size()) {
    progress.check();
    piece.resize(std::min<uint64_t>(piece.size(), file.size() - done));
    file.read(done, piece);
    digest.add(piece);
  }
  return digest.hex();
}

namespace {

constexpr size_t kBuffer = size_t{1} << 20;

/// The file to replace: a link's target, so that the link survives. Devices and folders are refused, because the rename
/// would replace a device by a file.
std::filesystem::path write_target(const std::string& path) {
  std::error_code ignored;
  const auto target = std::filesystem::is_symlink(path, ignored) ? std::filesystem::weakly_canonical(path, ignored)
                                                                 : std::filesystem::path(path);
  if (std::filesystem::exists(target, ignored) && !std::filesystem::is_regular_file(target, ignored))
    throw Error(Status::io, path + ": is not a regular file; choose another name.");
  return target;
}

/// Infix of a temporary file's name, between the target's name and the random part.
constexpr std::string_view kMark = ".velour-partial-";

/// Whether a temporary file has no writer: it is not locked, and not so new that its writer may be about to lock it.
bool is_left_over(const std::filesystem::path& file) {
  constexpr time_t kNew = 10;  // seconds
  const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
  struct stat info {};
  return fd.get() >= 0 && ::fstat(fd.get(), &info) == 0 && S_ISREG(info.st_mode) &&
         ::time(nullptr) - info.st_mtime > kNew && ::flock(fd.get(), LOCK_EX | LOCK_NB) == 0;
}

/// Removes the temporary files of killed writers from a folder. Only when this process first writes there, because some
/// folders hold tens of thousands of files. On file systems without locks, everything stays.
void remove_left_over(const std::filesystem::path& folder) {
  static std::mutex mutex;
  static std::set<std::filesystem::path> seen;
  const std::lock_guard lock(mutex);
  if (!seen.insert(folder).second) return;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const bool has_mark = entry->path().filename().string().find(kMark) != std::string::npos;
    if (has_mark && is_left_over(entry->path())) ::unlink(entry->path().c_str());
  }
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

/// Creates a new file beside the target, because renames are atomic only within a folder, and returns its descriptor
/// and `name`. The name is random: processes on other machines and in containers, whose ids may be equal, write to the
/// same folder. A network file system may report that a new file exists already; then another name is tried.
int create_beside(const std::filesystem::path& target, const std::string& path, std::string& name) {
  constexpr int kAttempts = 16;
  constexpr size_t kMaxStem = 160;  // bytes; names have at most 255
  remove_left_over(folder_of(target));
  std::random_device random;
  const std::string stem = (folder_of(target) / target.filename().string().substr(0, kMaxStem)).string();
  for (int attempt = 1;; ++attempt) {
    name = stem + std::string(kMark) + std::to_string(random()) + "-" + std::to_string(random());
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) {
      ::flock(fd, LOCK_EX | LOCK_NB);  // may fail without support for locks; then nobody removes the file
      return fd;
    }
    if (errno != EEXIST || attempt == kAttempts) fail_with_code(path, "write", errno);
  }
}

/// Makes the rename itself survive a power cut. Ignores errors: some file systems do not support it.
void sync_folder(const std::filesystem::path& target) {
  const Descriptor fd(::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
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
      failure_ = errno;
      fail_with_code(path_, "write", failure_);
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
    failure_ = errno;
    fail_with_code(path_, "write", failure_);
  }
  start_ = position;
}

void AtomicFile::commit() {
  if (failure_ != 0) fail_with_code(path_, "write", failure_);
  flush();
  if (::fsync(fd_.get()) != 0 || fd_.close() != 0) fail_with_code(path_, "write", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail_with_code(path_, "write", errno);
  committed_ = true;
  sync_folder(target_);
}

}  // namespace velour
