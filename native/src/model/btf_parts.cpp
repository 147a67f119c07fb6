#include "model/btf_parts.h"

#include <cmath>

#include "btf/btf_index.h"

namespace velour {
namespace {

constexpr char kIndex[] = "velour.btf.index", kCompanding[] = "velour.companding", kAxes[] = "btf.axes";
constexpr const char* kCompandingNames[] = {"none", "root"};

Companding companding_named(const ModelFields& fields) {
  const std::string& name = fields.attribute(kCompanding);
  if (name == kCompandingNames[0]) return Companding::none;
  if (name == kCompandingNames[1]) return Companding::root;
  fields.fail(std::string(kCompanding) + " is '" + name + "'; it must be none or root.");
}

Mat3 read_axes(const ModelFields& fields) {
  const Tensor& tensor = fields.tensor(kAxes);
  expect_shape(fields, kAxes, tensor, {3, 3});
  Mat3 axes;
  for (size_t i = 0; i < 9; ++i) {
    const float value = tensor.data[i];
    if (!(std::abs(value) <= 1.001f)) fields.fail_at(kAxes, i, value, "a component of a unit vector");
    axes[static_cast<int>(i / 3)][static_cast<int>(i % 3)] = value;
  }
  return axes;
}

}  // namespace

void write_btf_frame(const BtfFrame& frame, TensorFile& file) {
  file.packed = true;
  file.attributes[kIndex] = encode_btf_index({.layout = frame.layout, .grid = frame.grid}, std::nullopt);
  file.attributes[kCompanding] = kCompandingNames[static_cast<size_t>(frame.companding)];
  file.attributes["velour.units"] = "apparent BRDF in 1/sr, linear Rec. 709";
  Tensor& axes = file.tensors[kAxes] = {{3, 3}, {}};
  for (int i = 0; i < 9; ++i) axes.data.push_back(frame.axes[i / 3][i % 3]);
}

BtfFrame read_btf_frame(const ModelFields& fields) {
  const std::string& text = fields.attribute(kIndex);
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  const BtfIndex index = decode_btf_index(bytes, fields.name() + ": " + kIndex).index;
  if (!index.layout.complete())
    fields.fail(std::string(kIndex) + " lacks view-light pairs; a model must have all of them.");
  return {index.layout, index.grid, companding_named(fields), read_axes(fields)};
}

void expect_shape(const ModelFields& fields, const std::string& part, const Tensor& tensor,
                  const std::vector<uint64_t>& shape) {
  if (tensor.shape == shape) return;
  std::string text;
  for (const uint64_t extent : shape) text += (text.empty() ? "[" : ", ") + std::to_string(extent);
  fields.fail("the part " + part + " must have the shape " + text + "].");
}

std::vector<HalfBits> shaped_halves(const ModelFields& fields, const std::string& part,
                                    const std::vector<uint64_t>& shape) {
  const Tensor& tensor = fields.tensor(part);
  expect_shape(fields, part, tensor, shape);
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    if (!(std::abs(tensor.data[i]) <= kLargestHalf))
      fields.fail_at(part, i, tensor.data[i], "in the range of a half float (-65504 to 65504)");
  }
  std::vector<HalfBits> halves(tensor.data.size());
  floats_to_halves(tensor.data, halves);
  return halves;
}

Tensor tensor_of(const std::vector<HalfBits>& halves, const std::vector<uint64_t>& shape) {
  Tensor tensor{shape, std::vector<float>(halves.size()), Precision::halves};
  halves_to_floats(halves, tensor.data);
  return tensor;
}

Tensor maps_tensor(const std::vector<HalfBits>& values, uint64_t coefficients, uint32_t width, uint32_t height) {
  return tensor_of(transposed(values, coefficients), {coefficients, height, width});
}

std::vector<HalfBits> read_maps(const ModelFields& fields, const std::string& part, uint64_t coefficients,
                                uint32_t width, uint32_t height) {
  return transposed(shaped_halves(fields, part, {coefficients, height, width}), size_t{width} * height);
}

}  // namespace velour
