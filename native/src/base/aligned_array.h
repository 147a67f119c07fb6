// Arrays aligned to cache lines.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace velour {

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

}  // namespace velour
