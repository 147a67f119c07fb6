// Memory of one view's images, or a file in place of it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "base/scratch_pages.h"

namespace velour {

/// Zero-initialized array of halves; above `limit` bytes it is a temporary file in `folder` (see ScratchPages).
class ViewStore {
 public:
  /// Throws Error(io) if the file cannot be created.
  ViewStore(uint64_t halves, uint64_t limit, const std::string& folder)
      : halves_(halves), pages_(halves * sizeof(uint16_t), limit, folder) {}

  std::span<uint16_t> halves() const { return {static_cast<uint16_t*>(pages_.data()), halves_}; }
  /// Evicts the array from the process's memory; it is read back from the file on use. Thread-safe.
  void release() const { pages_.release(); }
  /// Runs `work`, which reads the array, and evicts what it has read in the meantime.
  void read_by(const std::function<void()>& work) const;

 private:
  const uint64_t halves_;
  const ScratchPages pages_;
};

}  // namespace velour
