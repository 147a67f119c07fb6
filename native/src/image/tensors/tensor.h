// Named tensors and texts, the content of Velour's own files.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace velour {

/// Precision of a tensor's values in a file. Values must be representable; writing never rounds.
enum class Precision {
  floats,  // 32 bits
  halves,  // 16 bits: every value is a half float (rounded_to_half)
  bytes,   // 8 bits: every value is a byte / 256; the last two dimensions are rows and columns of maps
};

/// Row-major.
struct Tensor {
  std::vector<uint64_t> shape;  // up to kMaxTensorRank extents; none: one value
  std::vector<float> data;
  Precision precision = Precision::floats;
};

constexpr size_t kMaxTensorRank = 16;

struct TensorFile {
  std::map<std::string, std::string> attributes;  // "velour.kind", "velour.format_version", ...: strings
  std::map<std::string, Tensor> tensors;          // by name
  /// Trades readability by other programs for size: they see only the smallest tensor and short attributes
  /// (tensor_pack.h). Required for tensors of bytes.
  bool packed = false;
};

/// The half float nearest to `value`; infinite above 65504.
float rounded_to_half(float value);

/// Number of elements; 0 if an extent is 0 or the product exceeds 2^40.
uint64_t element_count(const std::vector<uint64_t>& shape);

/// Extents as in "90 90 180"; "scalar" if there are none.
std::string shape_text(const std::vector<uint64_t>& shape);

/// Throws Error(invalid_argument) if the number of values does not match the shape, or values do not fit the precision.
void check_tensor(const std::string& name, const Tensor& tensor);

}  // namespace velour
