#include "image/tensors/tensor.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace velour {
namespace {

bool is_byte(float value) {
  const float byte = 256 * value;
  return byte >= 0 && byte <= 255 && byte == std::floor(byte);
}

void check_halves(const std::string& name, const Tensor& tensor) {
  for (const float value : tensor.data) {
    if (rounded_to_half(value) == value) continue;
    throw Error(Status::invalid_argument, "Tensor '" + name + "' cannot be stored as half floats, because " +
                                              std::to_string(value) + " is not a half float; round the values first.");
  }
}

void check_bytes(const std::string& name, const Tensor& tensor) {
  if (tensor.shape.size() >= 2 && std::all_of(tensor.data.begin(), tensor.data.end(), is_byte)) return;
  throw Error(
      Status::invalid_argument,
      "Tensor '" + name +
          "' cannot be stored as byte maps: it needs at least two dimensions and integer values from 0 to 255.");
}

}  // namespace

float rounded_to_half(float value) { return half(value); }

uint64_t element_count(const std::vector<uint64_t>& shape) {
  uint64_t count = 1;
  for (const uint64_t extent : shape) {
    if (extent == 0 || count > (uint64_t{1} << 40) / extent) return 0;
    count *= extent;
  }
  return count;
}

std::string shape_text(const std::vector<uint64_t>& shape) {
  if (shape.empty()) return "scalar";
  std::string text = std::to_string(shape[0]);
  for (size_t i = 1; i < shape.size(); ++i) text.append(" ").append(std::to_string(shape[i]));
  return text;
}

void check_tensor(const std::string& name, const Tensor& tensor) {
  const uint64_t count = element_count(tensor.shape);
  if (count == 0 || count != tensor.data.size() || tensor.shape.size() > kMaxTensorRank)
    throw Error(Status::invalid_argument, "Tensor '" + name + "' of shape '" + shape_text(tensor.shape) + "' has " +
                                              std::to_string(tensor.data.size()) +
                                              " values; the number must match the shape, with at most 16 dimensions.");
  if (tensor.precision == Precision::halves) check_halves(name, tensor);
  if (tensor.precision == Precision::bytes) check_bytes(name, tensor);
}

}  // namespace velour
