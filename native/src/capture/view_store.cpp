#include "capture/view_store.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "job/error.h"

namespace velour {
namespace {

/// A descriptor of a file that has no name any more.
int nameless_file(const std::string& folder, uint64_t bytes) {
  std::string name = folder + "/.velour-view-XXXXXX";
  const int file = mkstemp(name.data());
  if (file >= 0) unlink(name.c_str());
  // Allocated now: a full disk is a sentence here, and would be a signal when a page is touched.
  const int problem = file < 0 ? errno : posix_fallocate(file, 0, static_cast<off_t>(bytes));
  if (problem == 0) return file;
  if (file >= 0) close(file);
  throw Error(Status::io, folder + ": no temporary file of " + std::to_string(bytes) + " bytes can be made there: " +
                              std::strerror(problem) + ". Free space, or raise the memory limit.");
}

}  // namespace

ViewStore::ViewStore(uint64_t halves, uint64_t limit, const std::string& folder) : halves_(halves) {
  if (halves * sizeof(uint16_t) > limit) {
    map_file(folder);
  } else {
    memory_.resize(halves);
    data_ = memory_.data();
  }
}

void ViewStore::map_file(const std::string& folder) {
  const uint64_t bytes = halves_ * sizeof(uint16_t);
  const int file = nameless_file(folder, bytes);
  void* mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  const int problem = errno;
  close(file);
  if (mapped == MAP_FAILED) {
    throw Error(Status::io, folder + ": a temporary file cannot be mapped: " + std::strerror(problem) + ".");
  }
  mapped_ = mapped;
  data_ = static_cast<uint16_t*>(mapped);
}

ViewStore::~ViewStore() {
  if (mapped_ != nullptr) munmap(mapped_, halves_ * sizeof(uint16_t));
}

void ViewStore::release() const {
  if (mapped_ != nullptr) madvise(mapped_, halves_ * sizeof(uint16_t), MADV_DONTNEED);
}

void ViewStore::read_by(const std::function<void()>& work) const {
  if (mapped_ == nullptr) return work();
  std::jthread releases([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      release();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  work();
}

}  // namespace velour
