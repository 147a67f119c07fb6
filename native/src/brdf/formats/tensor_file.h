// The container of RGL's .bsdf files: named tensors of numbers.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace velour {

class ByteReader;

/// Type codes of the file format.
enum class TensorType : uint8_t {
  uint8 = 1,
  int8,
  uint16,
  int16,
  uint32,
  int32,
  uint64,
  int64,
  float16,
  float32,
  float64
};

struct TensorField {
  TensorType type;
  std::vector<uint64_t> shape;
  std::span<const uint8_t> bytes;  // of the values; borrowed from the file, not aligned
};

class TensorContainer {
 public:
  /// Checks every shape and offset against the size of `bytes`; fields may not overlap. `name` begins every message.
  TensorContainer(std::span<const uint8_t> bytes, std::string name);

  bool has(const std::string& field) const { return fields_.contains(field); }
  /// Throws Error(bad_data) if the field is missing, of another type or of another rank.
  const TensorField& get(const std::string& field, TensorType type, size_t rank) const;
  /// A float32 field, copied.
  std::vector<float> floats(const std::string& field, size_t rank) const;
  std::string text(const std::string& field) const;
  const std::vector<uint64_t>& shape(const std::string& field) const { return fields_.at(field).shape; }

  [[noreturn]] void fail(const std::string& field, const std::string& what) const;

 private:
  void read_entry(ByteReader& in);
  void check_layout(uint64_t header_end) const;

  std::string name_;
  std::map<std::string, TensorField> fields_;
  std::span<const uint8_t> file_;
};

bool looks_like_tensor_file(std::span<const uint8_t> head);

}  // namespace velour
