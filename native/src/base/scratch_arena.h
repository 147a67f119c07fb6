// Memory of short-lived objects of varying types, reused without allocation.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace velour {

/// A bump allocator for one thread: objects follow each other in one block, and reset() releases all at once. After the
/// first few rounds a round allocates nothing: the block grows only when a round needs more than any before it.
/// Destructors are not called.
class ScratchArena {
 public:
  ScratchArena() = default;
  ScratchArena(const ScratchArena&) = delete;
  ScratchArena& operator=(const ScratchArena&) = delete;
  ScratchArena(ScratchArena&&) = default;
  ScratchArena& operator=(ScratchArena&&) = default;

  /// An object that is valid until reset(); without arguments it is default-initialized.
  template <class T, class... Arguments>
  T* make(Arguments&&... arguments) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kLine);
    void* const place = take(sizeof(T));
    if constexpr (sizeof...(Arguments) == 0) {
      return new (place) T;
    } else {
      return new (place) T(std::forward<Arguments>(arguments)...);
    }
  }
  /// `count` default-initialized objects: numbers are unspecified.
  template <class T>
  std::span<T> make_array(size_t count) {
    static_assert(std::is_trivially_destructible_v<T> && alignof(T) <= kLine);
    T* const first = static_cast<T*>(take(count * sizeof(T)));
    std::uninitialized_default_construct_n(first, count);
    return {first, count};
  }

  /// Ends the life of all objects; keeps the memory.
  void reset() {
    if (!outgrown_.empty()) merge();
    used_ = 0;
  }

 private:
  static constexpr size_t kLine = 64;  // cache line; all objects begin at one
  struct Free {
    void operator()(std::byte* block) const { ::operator delete (block, std::align_val_t{kLine}); }
  };
  using Block = std::unique_ptr<std::byte, Free>;

  void* take(size_t bytes) {
    const size_t rounded = (bytes + kLine - 1) / kLine * kLine;
    if (rounded > size_ - used_) grow(rounded);
    void* const place = block_.get() + used_;
    used_ += rounded;
    return place;
  }
  /// Continues in a new block for at least `bytes`.
  void grow(size_t bytes);
  /// Replaces all blocks by one as large as all of them.
  void merge();
  void allocate(size_t bytes);

  Block block_;
  size_t size_ = 0, used_ = 0;
  std::vector<Block> outgrown_;  // full blocks of this round
  size_t outgrown_size_ = 0;
};

}  // namespace velour
