#include "base/memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/error.h"

namespace velour {

void ScratchArena::allocate(size_t bytes) {
  block_.reset(static_cast<std::byte*>(::operator new (bytes, std::align_val_t{kLine})));
  size_ = bytes;
  used_ = 0;
}

void ScratchArena::grow(size_t bytes) {
  constexpr size_t kFirst = 16 << 10;
  if (block_) {
    outgrown_size_ += size_;
    outgrown_.push_back(std::move(block_));
  }
  allocate(std::max({bytes, 2 * size_, kFirst}));
}

void ScratchArena::merge() {
  const size_t bytes = outgrown_size_ + size_;
  outgrown_.clear();
  outgrown_size_ = 0;
  allocate(bytes);
}

namespace {

/// Descriptor of a temporary file whose name has been unlinked.
int nameless_file(const std::string& folder, uint64_t bytes) {
  std::string name = folder + "/.velour-scratch-XXXXXX";
  const int file = mkstemp(name.data());
  if (file >= 0) unlink(name.c_str());
  // Allocated now: a full disk is an error message here, but would be a signal when a page is touched.
  const int problem = file < 0 ? errno : posix_fallocate(file, 0, static_cast<off_t>(bytes));
  if (problem == 0) return file;
  if (file >= 0) close(file);
  throw Error(Status::io, folder + ": cannot create a temporary file of " + std::to_string(bytes) +
                              " bytes: " + std::strerror(problem) + ". Free disk space, or raise the memory limit.");
}

}  // namespace

ScratchPages::ScratchPages(uint64_t bytes, uint64_t limit, const std::string& folder)
    : bytes_(bytes), in_file_(bytes > limit) {
  if (bytes == 0) return;
  const int file = in_file_ ? nameless_file(folder, bytes) : -1;
  // Without a file, memory also comes from mmap: the kernel zeroes each page on first use, in the thread that uses it.
  data_ = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, in_file_ ? MAP_SHARED : MAP_PRIVATE | MAP_ANONYMOUS, file, 0);
  const int problem = errno;
  if (file >= 0) close(file);
  if (data_ != MAP_FAILED) return;
  data_ = nullptr;
  if (!in_file_) throw std::bad_alloc();
  throw Error(Status::io,
              folder + ": cannot map a temporary file: " + std::strerror(problem) + ". Raise the memory limit.");
}

ScratchPages::~ScratchPages() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

void ScratchPages::release() const {
  if (in_file_) madvise(data_, bytes_, MADV_DONTNEED);
}

}  // namespace velour
