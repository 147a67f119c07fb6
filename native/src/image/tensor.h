// Named tensors and texts: what Velour's own files hold.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace velour {

/// What a file keeps of each value of a tensor, exactly: nothing is rounded on the way.
enum class Precision {
  floats,  // 32 bits
  halves,  // 16 bits: every value is one that a half float holds (rounded_to_half)
  bytes,   // 8 bits: every value is a byte over 256, the last two dimensions are rows and columns of maps
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
  /// Small rather than open to other programs: of tensors they see the first, of attributes those that are short
  /// (tensor_pack.h). Tensors of bytes need it.
  bool packed = false;
};

/// The half float nearest to `value`; infinite past 65504.
float rounded_to_half(float value);

/// Number of elements, or 0 where an extent is 0 or the product is beyond 2^40.
uint64_t element_count(const std::vector<uint64_t>& shape);

/// As in "90 90 180"; "scalar" without extents.
std::string shape_text(const std::vector<uint64_t>& shape);

/// Throws Error(invalid_argument) where values are more or fewer than the shape says, or not of its precision.
void check_tensor(const std::string& name, const Tensor& tensor);

}  // namespace velour
