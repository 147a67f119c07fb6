#include "base/file.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include "base/atomic_file.h"
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

}  // namespace velour
