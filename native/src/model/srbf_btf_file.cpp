#include "model/srbf_btf_file.h"

#include <cmath>

#include "image/half_image.h"
#include "model/btf_parts.h"

namespace velour {
namespace {

constexpr char kSides[] = "btf.sides", kShared[] = "btf.shared";

/// Names of the parts of side `number`.
struct SideParts {
  explicit SideParts(size_t number) : prefix("btf.side." + std::to_string(number) + ".") {}
  std::string lobes() const { return prefix + "lobes"; }
  std::string frames() const { return prefix + "frames"; }
  std::string coefficients() const { return prefix + "coefficients"; }
  std::string relief(size_t level) const { return prefix + "relief." + std::to_string(level); }
  std::string scales() const { return prefix + "scales"; }
  std::string bytes(size_t level) const { return prefix + "bytes." + std::to_string(level); }
  /// In files before 1.5.
  std::string texels(size_t level) const { return prefix + "texels." + std::to_string(level); }
  std::string prefix;
};

/// Pictures that a viewer shows: a byte over 256 is exact as a half float.
constexpr float kOfByte = 1.0f / 256;

Tensor bytes_tensor(const SrbfLevel& level, size_t coefficients) {
  Tensor tensor{{coefficients, level.height, level.width}, {}, true};
  for (const uint8_t byte : transposed(level.value, coefficients)) tensor.data.push_back(byte * kOfByte);
  return tensor;
}

void write_side(const SrbfSide& side, const SideParts& part, TensorFile& file) {
  Tensor& lobes = file.tensors[part.lobes()] = {{side.lobes.size(), 9}, {}, false};
  Tensor& frames = file.tensors[part.frames()] = {{side.lobes.size()}, {}, true};
  for (size_t j = 0; j < side.lobes.size(); ++j) {
    const MultivariateLobe& lobe = side.lobes[j];
    for (const Vec3& v : {lobe.light, lobe.view, lobe.half}) lobes.data.insert(lobes.data.end(), {v.x, v.y, v.z});
    frames.data.push_back(j < side.tile_lobes ? 0.0f : 1.0f);
  }
  Tensor& coefficients = file.tensors[part.coefficients()] = {{side.coefficients(), 2}, {}, true};
  for (size_t a = 0; a < 3; ++a) {
    for (const uint16_t lobe : side.lobe[a]) {
      coefficients.data.insert(coefficients.data.end(), {static_cast<float>(a), static_cast<float>(lobe)});
    }
  }
  Tensor& scales = file.tensors[part.scales()] = {{side.coefficients(), 2}, {}, false};
  for (const ByteScale& s : side.scale) scales.data.insert(scales.data.end(), {s.least, s.step});
  for (size_t l = 0; l < side.levels.size(); ++l) {
    const SrbfLevel& level = side.levels[l];
    file.tensors[part.relief(l)] = tensor_of(level.relief, {level.height, level.width});
    file.tensors[part.bytes(l)] = bytes_tensor(level, side.coefficients());
  }
}

void read_lobes(const ModelFields& fields, const SideParts& part, SrbfSide& side) {
  constexpr float kSharpest = 1e6f;  // bandwidths of any use are far below
  const Tensor& lobes = fields.rows(part.lobes(), 9);
  const size_t count = lobes.data.size() / 9;
  if (count > SrbfBtf::kMaxLobes) {
    fields.fail(part.lobes() + " has " + std::to_string(count) + " lobes; a model has at most " +
                std::to_string(SrbfBtf::kMaxLobes) + ".");
  }
  for (size_t i = 0; i < lobes.data.size(); ++i) {
    if (!(std::abs(lobes.data[i]) <= kSharpest)) fields.fail_at(part.lobes(), i, lobes.data[i], "at most 1e6");
  }
  for (const float* v = lobes.data.data(); side.lobes.size() < count; v += 9) {
    side.lobes.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}});
  }
  const Tensor& frames = fields.tensor(part.frames());
  expect_shape(fields, part.frames(), frames, {count});
  for (size_t j = 0; j < count; ++j) {
    const float frame = frames.data[j];
    if (frame != 0 && frame != 1) fields.fail_at(part.frames(), j, frame, "0 (tile) or 1 (texel)");
    if (frame == 0 && side.tile_lobes < j) fields.fail_at(part.frames(), j, frame, "1, as those before");
    side.tile_lobes += frame == 0;
  }
}

void read_coefficients(const ModelFields& fields, const SideParts& part, SrbfSide& side) {
  const Tensor& tensor = fields.rows(part.coefficients(), 2);
  const size_t count = tensor.data.size() / 2;
  if (count > 3 * SrbfBtf::kMaxLobes) fields.fail(part.coefficients() + " has too many rows.");
  float least = 0;
  for (size_t k = 0; k < count; ++k) {
    const float axis = tensor.data[2 * k], lobe = tensor.data[2 * k + 1];
    if (!(axis >= least && axis <= 2 && axis == std::floor(axis))) {
      fields.fail_at(part.coefficients(), 2 * k, axis, "0, 1 or 2, never falling");
    }
    least = axis;
    const bool in_order = axis > 0 || lobe == static_cast<float>(k);
    if (!(lobe >= 0 && lobe < static_cast<float>(side.lobes.size()) && lobe == std::floor(lobe) && in_order)) {
      fields.fail_at(part.coefficients(), 2 * k + 1, lobe, "the number of a lobe (for axis 0: all, in order)");
    }
    side.lobe[static_cast<size_t>(axis)].push_back(static_cast<uint16_t>(lobe));
  }
  if (side.lobe[0].size() != side.lobes.size()) fields.fail(part.coefficients() + " leaves out lobes of axis 0.");
}

void read_scales(const ModelFields& fields, const SideParts& part, SrbfSide& side) {
  const Tensor& tensor = fields.tensor(part.scales());
  expect_shape(fields, part.scales(), tensor, {side.coefficients(), 2});
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float value = tensor.data[i];
    if (!(std::abs(value) <= kLargestHalf && (i % 2 == 0 || value >= 0))) {
      fields.fail_at(part.scales(), i, value, i % 2 == 0 ? "at most 65504" : "from 0 to 65504");
    }
  }
  for (size_t k = 0; k < side.coefficients(); ++k) side.scale.push_back({tensor.data[2 * k], tensor.data[2 * k + 1]});
}

std::vector<uint8_t> read_bytes(const ModelFields& fields, const std::string& part, const SrbfLevel& level,
                                size_t coefficients) {
  const Tensor& tensor = fields.tensor(part);
  expect_shape(fields, part, tensor, {coefficients, level.height, level.width});
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float byte = tensor.data[i] / kOfByte;
    if (!(byte >= 0 && byte <= 255 && byte == std::floor(byte))) {
      fields.fail_at(part, i, tensor.data[i], "0 to 255 over 256");
    }
    bytes.push_back(static_cast<uint8_t>(byte));
  }
  return transposed(bytes, size_t{level.width} * level.height);
}

/// Files before 1.5 have half floats in place of bytes; they become bytes here.
void read_half_values(const ModelFields& fields, const SideParts& part, SrbfSide& side) {
  std::vector<std::vector<float>> values;
  for (size_t l = 0; l < side.levels.size(); ++l) {
    const SrbfLevel& level = side.levels[l];
    const auto halves = read_maps(fields, part.texels(l), side.coefficients(), level.width, level.height);
    halves_to_floats(halves, values.emplace_back(halves.size()));
  }
  side.set_scale(values);
  side.set_values(values);
}

SrbfSide read_side(const ModelFields& fields, const SideParts& part, const TexelGrid& grid) {
  SrbfSide side;
  read_lobes(fields, part, side);
  read_coefficients(fields, part, side);
  for (uint32_t width = grid.width, height = grid.height;; width = half_of(width), height = half_of(height)) {
    side.levels.push_back({width, height, shaped_halves(fields, part.relief(side.levels.size()), {height, width}), {}});
    if (width == 1 && height == 1) break;
  }
  if (fields.has(part.texels(0))) {
    read_half_values(fields, part, side);
    return side;
  }
  read_scales(fields, part, side);
  for (size_t l = 0; l < side.levels.size(); ++l) {
    side.levels[l].value = read_bytes(fields, part.bytes(l), side.levels[l], side.coefficients());
  }
  return side;
}

std::vector<SharedSide> read_shared(const ModelFields& fields, size_t sides) {
  std::vector<SharedSide> shared;
  if (!fields.has(kShared)) return shared;
  const Tensor& tensor = fields.rows(kShared, 3);
  if (tensor.data.size() > 9) fields.fail(std::string(kShared) + " has more than three rows.");
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float value = tensor.data[i], most = i % 3 == 2 ? static_cast<float>(sides) - 1 : 1.0f;
    if (!(value >= 0 && value <= most && value == std::floor(value))) {
      fields.fail_at(kShared, i, value, "0 (above) or 1 (below), and the number of a side");
    }
  }
  for (const float* v = tensor.data.data(); shared.size() < tensor.data.size() / 3; v += 3) {
    shared.push_back({v[0] != 0, v[1] != 0, static_cast<uint32_t>(v[2])});
  }
  return shared;
}

}  // namespace

void write_srbf_btf(const SrbfBtf& btf, TensorFile& file) {
  write_btf_frame({btf.layout, btf.grid, btf.companding, btf.axes}, file);
  Tensor& sides = file.tensors[kSides] = {{btf.sides.size(), 2}, {}, true};
  for (size_t s = 0; s < btf.sides.size(); ++s) {
    const SrbfSide& side = btf.sides[s];
    sides.data.insert(sides.data.end(), {side.view_below ? 1.0f : 0.0f, side.light_below ? 1.0f : 0.0f});
    write_side(side, SideParts(s), file);
  }
  if (btf.shared.empty()) return;
  Tensor& shared = file.tensors[kShared] = {{btf.shared.size(), 3}, {}, true};
  for (const SharedSide& s : btf.shared) {
    shared.data.insert(shared.data.end(),
                       {s.view_below ? 1.0f : 0.0f, s.light_below ? 1.0f : 0.0f, static_cast<float>(s.side)});
  }
}

SrbfBtf read_srbf_btf(const ModelFields& fields) {
  const BtfFrame frame = read_btf_frame(fields);
  SrbfBtf btf{frame.layout, frame.grid, frame.companding, frame.axes, {}};
  const Tensor& sides = fields.rows(kSides, 2);
  if (sides.data.size() > 8) fields.fail(std::string(kSides) + " has more than four rows.");
  for (size_t i = 0; i < sides.data.size(); ++i) {
    if (sides.data[i] != 0 && sides.data[i] != 1) fields.fail_at(kSides, i, sides.data[i], "0 (above) or 1 (below)");
  }
  for (size_t s = 0; 2 * s < sides.data.size(); ++s) {
    SrbfSide& side = btf.sides.emplace_back(read_side(fields, SideParts(s), btf.grid));
    side.view_below = sides.data[2 * s] != 0;
    side.light_below = sides.data[2 * s + 1] != 0;
  }
  btf.shared = read_shared(fields, btf.sides.size());
  return btf;
}

}  // namespace velour
