// Memory of one view's images, or a file in its place.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "file/scratch_pages.h"

namespace velour {

/// Zeros at first; above `limit` bytes as a temporary file in `folder`, as of ScratchPages.
class ViewStore {
 public:
  /// Throws Error(io) when the file cannot be made.
  ViewStore(uint64_t halves, uint64_t limit, const std::string& folder)
      : halves_(halves), pages_(halves * sizeof(uint16_t), limit, folder) {}

  std::span<uint16_t> halves() const { return {static_cast<uint16_t*>(pages_.data()), halves_}; }
  /// Takes the array out of the process's memory; it is read from the file again when used. Thread-safe.
  void release() const { pages_.release(); }
  /// Runs `work`, which reads the array, and releases while it does.
  void read_by(const std::function<void()>& work) const;

 private:
  const uint64_t halves_;
  const ScratchPages pages_;
};

}  // namespace velour
