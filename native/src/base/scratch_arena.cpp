#include "base/scratch_arena.h"

#include <algorithm>

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

}  // namespace velour
