#include "model/srbf_btf_file.h"

#include <cmath>

#include "image/half_image.h"
#include "model/btf_sides.h"

namespace velour {
namespace {

/// Names of the parts of side `number`.
struct SrbfSideParts {
  explicit SrbfSideParts(size_t number) : prefix(side_prefix(number)) {}
  std::string lobes() const { return prefix + "lobes"; }
  std::string frames() const { return prefix + "frames"; }
  std::string coefficients() const { return prefix + "coefficients"; }
  std::string relief(size_t level) const { return prefix + "relief." + std::to_string(level); }
  std::string scales() const { return prefix + "scales"; }
  std::string bytes(size_t level) const { return prefix + "bytes." + std::to_string(level); }
  /// Only in files before version 1.5.
  std::string texels(size_t level) const { return prefix + "texels." + std::to_string(level); }
  std::string prefix;
};

void write_side(const SrbfSide& side, const SrbfSideParts& part, TensorFile& file) {
  Tensor& lobes = file.tensors[part.lobes()] = {{side.lobes.size(), MultivariateLobe::kNumbers}, {}};
  Tensor& frames = file.tensors[part.frames()] = {{side.lobes.size()}, {}, Precision::halves};
  for (size_t j = 0; j < side.lobes.size(); ++j) {
    const MultivariateLobe& lobe = side.lobes[j];
    for (int i = 0; i < MultivariateLobe::kNumbers; ++i) lobes.data.push_back(lobe[i]);
    frames.data.push_back(j < side.tile_lobes ? 0.0f : 1.0f);
  }
  Tensor& coefficients = file.tensors[part.coefficients()] = {{side.coefficients(), 2}, {}, Precision::halves};
  for (size_t a = 0; a < 3; ++a) {
    for (const uint16_t lobe : side.lobe[a]) {
      coefficients.data.insert(coefficients.data.end(), {static_cast<float>(a), static_cast<float>(lobe)});
    }
  }
  file.tensors[part.scales()] = scales_tensor(side.scale, {side.coefficients()});
  for (size_t l = 0; l < side.levels.size(); ++l) {
    const SrbfLevel& level = side.levels[l];
    file.tensors[part.relief(l)] = tensor_of(level.relief, {level.height, level.width});
    file.tensors[part.bytes(l)] = byte_maps(level.value, side.coefficients(), level.width, level.height);
  }
}

/// Numbers per lobe; files before version 1.6 lack those of the phase.
size_t lobe_numbers(const Tensor& lobes) {
  constexpr size_t kBefore = 9;
  return lobes.shape.size() == 2 && lobes.shape[1] == kBefore ? kBefore : size_t{MultivariateLobe::kNumbers};
}

void read_lobes(const ModelFields& fields, const SrbfSideParts& part, SrbfSide& side) {
  constexpr float kSharpest = 1e6f;  // useful bandwidths are far below
  const size_t numbers = lobe_numbers(fields.tensor(part.lobes()));
  const Tensor& lobes = fields.rows(part.lobes(), numbers);
  const size_t count = lobes.data.size() / numbers;
  if (count > SrbfBtf::kMaxLobes) {
    fields.fail(part.lobes() + " has " + std::to_string(count) + " lobes; a model has at most " +
                std::to_string(SrbfBtf::kMaxLobes) + ".");
  }
  for (size_t i = 0; i < lobes.data.size(); ++i) {
    if (!(std::abs(lobes.data[i]) <= kSharpest)) fields.fail_at(part.lobes(), i, lobes.data[i], "at most 1e6");
  }
  side.lobes.resize(count);
  for (size_t i = 0; i < lobes.data.size(); ++i) {
    side.lobes[i / numbers][static_cast<int>(i % numbers)] = lobes.data[i];
  }
  const Tensor& frames = fields.tensor(part.frames());
  expect_shape(fields, part.frames(), frames, {count});
  for (size_t j = 0; j < count; ++j) {
    const float frame = frames.data[j];
    if (frame != 0 && frame != 1) fields.fail_at(part.frames(), j, frame, "0 (tile) or 1 (texel)");
    if (frame == 0 && side.tile_lobes < j) fields.fail_at(part.frames(), j, frame, "1, like the frames before it");
    side.tile_lobes += frame == 0;
  }
}

void read_coefficients(const ModelFields& fields, const SrbfSideParts& part, SrbfSide& side) {
  const Tensor& tensor = fields.rows(part.coefficients(), 2);
  const size_t count = tensor.data.size() / 2;
  if (count > 3 * SrbfBtf::kMaxLobes)
    fields.fail(part.coefficients() + " has too many rows; the model file is damaged.");
  float least = 0;
  for (size_t k = 0; k < count; ++k) {
    const float axis = tensor.data[2 * k], lobe = tensor.data[2 * k + 1];
    if (!(axis >= least && axis <= 2 && axis == std::floor(axis))) {
      fields.fail_at(part.coefficients(), 2 * k, axis, "0, 1 or 2 in non-decreasing order");
    }
    least = axis;
    const bool in_order = axis > 0 || lobe == static_cast<float>(k);
    if (!(lobe >= 0 && lobe < static_cast<float>(side.lobes.size()) && lobe == std::floor(lobe) && in_order)) {
      fields.fail_at(part.coefficients(), 2 * k + 1, lobe, "the index of a lobe (for axis 0: all lobes, in order)");
    }
    side.lobe[static_cast<size_t>(axis)].push_back(static_cast<uint16_t>(lobe));
  }
  if (side.lobe[0].size() != side.lobes.size())
    fields.fail(part.coefficients() + " lacks lobes of axis 0; the model file is damaged.");
}

/// Files before version 1.5 store half floats, which are converted to bytes here.
void read_half_values(const ModelFields& fields, const SrbfSideParts& part, SrbfSide& side) {
  std::vector<std::vector<float>> values;
  for (size_t l = 0; l < side.levels.size(); ++l) {
    const SrbfLevel& level = side.levels[l];
    const auto halves = read_maps(fields, part.texels(l), side.coefficients(), level.width, level.height);
    halves_to_floats(halves, values.emplace_back(halves.size()));
  }
  side.set_scale(values);
  side.set_values(values);
}

SrbfSide read_side(const ModelFields& fields, const SrbfSideParts& part, const TexelGrid& grid) {
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
  side.scale = read_scales(fields, part.scales(), {side.coefficients()});
  for (size_t l = 0; l < side.levels.size(); ++l) {
    SrbfLevel& level = side.levels[l];
    level.value = read_byte_maps(fields, part.bytes(l), side.coefficients(), level.width, level.height);
  }
  return side;
}

}  // namespace

void write_srbf_btf(const SrbfBtf& btf, TensorFile& file) {
  write_btf_frame({btf.layout, btf.grid, btf.companding, btf.axes}, file);
  write_side_table(side_table(btf), file);
  for (size_t s = 0; s < btf.sides.size(); ++s) write_side(btf.sides[s], SrbfSideParts(s), file);
}

SrbfBtf read_srbf_btf(const ModelFields& fields) {
  const BtfFrame frame = read_btf_frame(fields);
  SrbfBtf btf{frame.layout, frame.grid, frame.companding, frame.axes, {}};
  SideTable table = read_side_table(fields);
  for (const SideTable::Place& place : table.sides) {
    SrbfSide& side = btf.sides.emplace_back(read_side(fields, SrbfSideParts(btf.sides.size()), btf.grid));
    side.view_below = place.view_below;
    side.light_below = place.light_below;
  }
  btf.shared = std::move(table.shared);
  return btf;
}

}  // namespace velour
