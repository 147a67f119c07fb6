// Memory of one view's images, or a file in its place.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace velour {

/// Zeros at first. Above `limit` bytes the array is a mapped temporary file in `folder` that has no name, so that a
/// killed capture leaves nothing; its pages are given back whenever release() is called.
class ViewStore {
 public:
  /// Throws Error(io) when the file cannot be made.
  ViewStore(uint64_t halves, uint64_t limit, const std::string& folder);
  ~ViewStore();
  ViewStore(const ViewStore&) = delete;
  ViewStore& operator=(const ViewStore&) = delete;

  std::span<uint16_t> halves() const { return {static_cast<uint16_t*>(data_), halves_}; }
  /// Takes the array out of the process's memory; it is read from the file again when used. Thread-safe.
  void release() const;
  /// Runs `work`, which reads the array, and releases while it does.
  void read_by(const std::function<void()>& work) const;

 private:
  uint64_t bytes() const { return halves_ * sizeof(uint16_t); }

  const uint64_t halves_;
  bool in_file_ = false;
  void* data_ = nullptr;  // pages of our own
};

}  // namespace velour
