// Memory: arrays aligned to cache lines, arenas of short-lived objects, pages that may lie in a file.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace velour {

// Arrays aligned to cache lines.

/// Uninitialized array of a trivial type.
template <class T>
class AlignedArray {
 public:
  explicit AlignedArray(size_t count)
      : size_(count), data_(static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kLine}))) {}

  size_t size() const { return size_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }

 private:
  static constexpr size_t kLine = 64;
  struct Free {
    void operator()(T* data) const { ::operator delete (data, std::align_val_t{kLine}); }
  };
  size_t size_;
  std::unique_ptr<T, Free> data_;
};

inline AlignedArray<float> aligned_zeros(size_t count) {
  AlignedArray<float> floats(count);
  std::fill_n(floats.data(), count, 0.0f);
  return floats;
}

// Memory of short-lived objects of varying types, reused without allocation.

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

// Temporary memory that may exceed the machine's.

/// Zeroed pages. Above `limit` bytes they are backed by an unnamed temporary file in `folder`, so that a killed process
/// leaves nothing behind, and release() can evict them from memory.
class ScratchPages {
 public:
  /// Throws Error(io) if the file cannot be created, std::bad_alloc if there is no memory.
  ScratchPages(uint64_t bytes, uint64_t limit, const std::string& folder);
  ~ScratchPages();
  ScratchPages(const ScratchPages&) = delete;
  ScratchPages& operator=(const ScratchPages&) = delete;

  /// Null for 0 bytes.
  void* data() const { return data_; }
  bool in_file() const { return in_file_; }
  /// Evicts file-backed pages from the process's memory; they are read back when used. Thread-safe.
  void release() const;

 private:
  const uint64_t bytes_;
  const bool in_file_;
  void* data_ = nullptr;
};

}  // namespace velour
