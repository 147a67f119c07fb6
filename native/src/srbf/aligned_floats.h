// Floats from the start of a cache line.
#pragma once

#include <cstddef>
#include <new>

namespace velour {

/// Uninitialised.
class AlignedFloats {
 public:
  explicit AlignedFloats(size_t count) : data_(static_cast<float*>(::operator new(count * sizeof(float), kLine))) {}
  ~AlignedFloats() { ::operator delete(data_, kLine); }
  AlignedFloats(const AlignedFloats&) = delete;
  AlignedFloats& operator=(const AlignedFloats&) = delete;

  float* data() { return data_; }
  const float* data() const { return data_; }

 private:
  static constexpr std::align_val_t kLine{64};
  float* data_;
};

}  // namespace velour
