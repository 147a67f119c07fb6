#include "model/file/btf_sides.h"

#include <cmath>
#include "btf/formats/btf_index.h"

namespace velour {

namespace {

constexpr char kSides[] = "btf.sides", kShared[] = "btf.shared";
/// A byte over 256 is exact as a half float.
constexpr float kOfByte = 1.0f / 256;

float flag(bool below) { return below ? 1.0f : 0.0f; }

std::vector<SideTable::Place> read_sides(const ModelFields& fields) {
  const Tensor& tensor = fields.rows(kSides, 2);
  if (tensor.data.size() > 8) fields.fail(std::string(kSides) + " has more than four rows.");
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float value = tensor.data[i];
    if (value != 0 && value != 1) fields.fail_at(kSides, i, value, "0 (above) or 1 (below)");
  }
  std::vector<SideTable::Place> sides;
  for (size_t i = 0; i < tensor.data.size(); i += 2) sides.push_back({tensor.data[i] != 0, tensor.data[i + 1] != 0});
  return sides;
}

std::vector<SharedSide> read_shared(const ModelFields& fields, size_t sides) {
  std::vector<SharedSide> shared;
  if (!fields.has(kShared)) return shared;
  const Tensor& tensor = fields.rows(kShared, 3);
  if (tensor.data.size() > 9) fields.fail(std::string(kShared) + " has more than three rows.");
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float value = tensor.data[i], most = i % 3 == 2 ? static_cast<float>(sides) - 1 : 1.0f;
    if (!(value >= 0 && value <= most && value == std::floor(value))) {
      fields.fail_at(kShared, i, value, "0 (above) or 1 (below), followed by the index of a side");
    }
  }
  for (const float* v = tensor.data.data(); shared.size() < tensor.data.size() / 3; v += 3) {
    shared.push_back({v[0] != 0, v[1] != 0, static_cast<uint32_t>(v[2])});
  }
  return shared;
}

}  // namespace

std::string side_prefix(size_t number) { return "btf.side." + std::to_string(number) + "."; }

void write_side_table(const SideTable& table, TensorFile& file) {
  Tensor& sides = file.tensors[kSides] = {{table.sides.size(), 2}, {}, Precision::halves};
  for (const SideTable::Place& s : table.sides) {
    sides.data.insert(sides.data.end(), {flag(s.view_below), flag(s.light_below)});
  }
  if (table.shared.empty()) return;
  Tensor& shared = file.tensors[kShared] = {{table.shared.size(), 3}, {}, Precision::halves};
  for (const SharedSide& s : table.shared) {
    shared.data.insert(shared.data.end(), {flag(s.view_below), flag(s.light_below), static_cast<float>(s.side)});
  }
}

SideTable read_side_table(const ModelFields& fields) {
  SideTable table{read_sides(fields), {}};
  table.shared = read_shared(fields, table.sides.size());
  return table;
}

Tensor byte_maps(const std::vector<uint8_t>& bytes, uint64_t coefficients, uint32_t width, uint32_t height) {
  Tensor tensor{{coefficients, height, width}, {}, Precision::bytes};
  for (const uint8_t byte : transposed(bytes, coefficients)) tensor.data.push_back(byte * kOfByte);
  return tensor;
}

std::vector<uint8_t> read_byte_maps(const ModelFields& fields, const std::string& part, uint64_t coefficients,
                                    uint32_t width, uint32_t height) {
  const Tensor& tensor = fields.tensor(part);
  expect_shape(fields, part, tensor, {coefficients, height, width});
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float byte = tensor.data[i] / kOfByte;
    if (!(byte >= 0 && byte <= 255 && byte == std::floor(byte))) {
      fields.fail_at(part, i, tensor.data[i], "a multiple of 1/256 from 0 to 255/256");
    }
    bytes.push_back(static_cast<uint8_t>(byte));
  }
  return transposed(bytes, size_t{width} * height);
}

/// Functions may have a norm of 1, so that coefficients reach the norm of all values: 65504 times the square root of
/// the number of pairs. Sums over coefficients, and their squares, remain finite floats.
constexpr float kMaxScale = 1e10f;

Tensor scales_tensor(const std::vector<ByteScale>& scales, std::vector<uint64_t> shape) {
  shape.push_back(2);
  Tensor tensor{std::move(shape), {}};
  for (const ByteScale& s : scales) tensor.data.insert(tensor.data.end(), {s.least, s.step});
  return tensor;
}

std::vector<ByteScale> read_scales(const ModelFields& fields, const std::string& part, std::vector<uint64_t> shape) {
  const Tensor& tensor = fields.tensor(part);
  shape.push_back(2);
  expect_shape(fields, part, tensor, shape);
  std::vector<ByteScale> scales;
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float value = tensor.data[i];
    if (!(std::abs(value) <= kMaxScale && (i % 2 == 0 || value >= 0))) {
      fields.fail_at(part, i, value, i % 2 == 0 ? "from -1e10 to 1e10" : "from 0 to 1e10");
    }
  }
  for (size_t i = 0; i < tensor.data.size(); i += 2) scales.push_back({tensor.data[i], tensor.data[i + 1]});
  return scales;
}

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
