// A bounds-checked cursor over bytes in memory. Errors name the field that was read.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "base/error.h"

namespace velour {

static_assert(std::endian::native == std::endian::little, "files are little-endian and read by copying");

class ByteReader {
 public:
  /// `name` is the file's name in error messages; `bytes` are borrowed.
  ByteReader(std::span<const uint8_t> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  uint64_t position() const { return position_; }
  uint64_t remaining() const { return bytes_.size() - position_; }
  const std::string& name() const { return name_; }

  void seek(uint64_t position, const std::string& field) {
    if (position > bytes_.size()) fail(field + " points to byte " + std::to_string(position));
    position_ = position;
  }

  std::span<const uint8_t> take(uint64_t count, const std::string& field) {
    if (count > remaining())
      fail(field + " needs " + std::to_string(count) + " bytes at byte " + std::to_string(position_));
    const auto part = bytes_.subspan(position_, count);
    position_ += count;
    return part;
  }

  /// Reads a little-endian number.
  template <typename T>
  T number(const std::string& field) {
    T value;
    std::memcpy(&value, take(sizeof(T), field).data(), sizeof(T));
    return value;
  }

  /// Reads text up to a zero byte, which is consumed; at most `limit` characters.
  std::string text(uint64_t limit, const std::string& field) {
    const auto rest = bytes_.subspan(position_);
    for (uint64_t i = 0; i <= limit && i < rest.size(); ++i) {
      if (rest[i] != 0) continue;
      position_ += i + 1;
      return {rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(i)};
    }
    throw Error(Status::bad_data, name_ + ": " + field + " at byte " + std::to_string(position_) +
                                      " does not end within " + std::to_string(limit) +
                                      " characters; the file is damaged.");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Status::bad_data, name_ + ": " + what + ", but the file holds " + std::to_string(bytes_.size()) +
                                      "; it is truncated or damaged.");
  }

  std::span<const uint8_t> bytes_;
  std::string name_;
  uint64_t position_ = 0;
};

}  // namespace velour
