#include "model/btf_sides.h"

#include <cmath>

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
    if (!(std::abs(value) <= kLargestHalf && (i % 2 == 0 || value >= 0))) {
      fields.fail_at(part, i, value, i % 2 == 0 ? "from -65504 to 65504" : "from 0 to 65504");
    }
  }
  for (size_t i = 0; i < tensor.data.size(); i += 2) scales.push_back({tensor.data[i], tensor.data[i + 1]});
  return scales;
}

}  // namespace velour
