#include <algorithm>
#include <cmath>

#include "image/texels.h"
#include "model/file/btf_sides.h"
#include "model/file/model_parts.h"

namespace velour {

namespace {

constexpr char kAxis[] = "btf.axis", kPairs[] = "btf.pairs", kLights[] = "btf.lights", kView[] = "btf.view";

std::string level_name(size_t level) { return "btf.texels." + std::to_string(level); }

const char* functions_name(const FactoredBtf& btf) { return btf.by_view() ? kLights : kPairs; }

const Tensor& limited_row(const ModelFields& fields, const char* part, size_t most) {
  const Tensor& tensor = fields.rows(part, 1);
  if (tensor.data.size() > most) {
    fields.fail(std::string(part) + " has " + std::to_string(tensor.data.size()) + " components; a model has at most " +
                std::to_string(most) + ".");
  }
  return tensor;
}

/// View of each component; empty if all components serve all views.
std::vector<uint16_t> read_views(const ModelFields& fields, size_t views) {
  std::vector<uint16_t> view;
  if (!fields.has(kView)) return view;
  const Tensor& tensor = limited_row(fields, kView, FactoredBtf::kMaxOfViews);
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float v = tensor.data[i];
    const uint16_t least = view.empty() ? 0 : view.back();
    if (!(v >= least && v < static_cast<float>(views) && v == std::floor(v))) {
      fields.fail_at(kView, i, v, "a view index in non-decreasing order");
    }
    view.push_back(static_cast<uint16_t>(v));
    if (i >= FactoredBtf::kMaxOfView && view[i - FactoredBtf::kMaxOfView] == view[i]) {
      fields.fail_at(kView, i, v,
                     "the view index of at most " + std::to_string(FactoredBtf::kMaxOfView) + " components");
    }
  }
  return view;
}

/// `view`: view of each component, or empty.
std::vector<uint8_t> read_axis_numbers(const ModelFields& fields, const std::vector<uint16_t>& view) {
  const Tensor& tensor = limited_row(fields, kAxis, view.empty() ? FactoredBtf::kMaxComponents : view.size());
  if (!view.empty()) expect_shape(fields, kAxis, tensor, {view.size()});
  std::vector<uint8_t> axis;
  float least = 0;
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float a = tensor.data[i];
    if (i > 0 && !view.empty() && view[i] != view[i - 1]) least = 0;
    if (!(a >= least && a <= 2 && a == std::floor(a))) fields.fail_at(kAxis, i, a, "0, 1 or 2 in non-decreasing order");
    axis.push_back(static_cast<uint8_t>(least = a));
  }
  return axis;
}

}  // namespace

void write_factored(const FactoredBtf& btf, TensorFile& file) {
  const uint64_t components = btf.components();
  write_btf_frame({btf.layout, btf.grid, btf.companding, btf.axes}, file);
  file.tensors[kAxis] = {{components}, std::vector<float>(btf.axis.begin(), btf.axis.end()), Precision::halves};
  if (btf.by_view()) file.tensors[kView] = {{components}, std::vector<float>(btf.view.begin(), btf.view.end())};
  file.tensors[functions_name(btf)] = tensor_of(btf.pair_value, {btf.function_rows(), components});
  for (size_t l = 0; l < btf.levels.size(); ++l) {
    const TexelLevel& level = btf.levels[l];
    file.tensors[level_name(l)] = maps_tensor(level.value, components, level.width, level.height);
  }
}

FactoredBtf read_factored(const ModelFields& fields) {
  const BtfFrame frame = read_btf_frame(fields);
  FactoredBtf btf{frame.layout, frame.grid, frame.companding, frame.axes, {}, {}, {}};
  btf.view = read_views(fields, btf.layout.views().size());
  btf.axis = read_axis_numbers(fields, btf.view);
  btf.pair_value = shaped_halves(fields, functions_name(btf), {btf.function_rows(), btf.components()});
  uint32_t width = btf.grid.width, height = btf.grid.height;
  for (;; width = half_of(width), height = half_of(height)) {
    const std::string part = level_name(btf.levels.size());
    btf.levels.push_back({width, height, read_maps(fields, part, btf.components(), width, height)});
    if (width == 1 && height == 1) return btf;
  }
}

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

namespace {

/// Names of the parts of side `number`.
struct TensorSideParts {
  explicit TensorSideParts(size_t number) : prefix(side_prefix(number)) {}
  std::string view() const { return prefix + "view"; }
  std::string light() const { return prefix + "light"; }
  std::string color() const { return prefix + "color"; }
  std::string core() const { return prefix + "core"; }
  std::string scales() const { return prefix + "scales"; }
  std::string relief(size_t level) const { return prefix + "relief." + std::to_string(level); }
  std::string members(size_t level) const { return prefix + "members." + std::to_string(level); }
  std::string bytes(size_t level) const { return prefix + "bytes." + std::to_string(level); }
  std::string prefix;
};

/// Concatenates the member `own` of all clusters.
template <typename Value>
std::vector<Value> joined(const TensorSide& side, std::vector<Value> TensorBtfCluster::*own) {
  std::vector<Value> all;
  for (const TensorBtfCluster& c : side.clusters) all.insert(all.end(), (c.*own).begin(), (c.*own).end());
  return all;
}
template <typename Value>
void split(const std::vector<Value>& all, std::vector<Value> TensorBtfCluster::*own, TensorSide& side) {
  const auto each = static_cast<std::ptrdiff_t>(all.size() / side.clusters.size());
  auto from = all.begin();
  for (TensorBtfCluster& c : side.clusters) {
    (c.*own).assign(from, from + each);
    from += each;
  }
}

void write_side(const TensorSide& side, const TensorSideParts& part, TensorFile& file) {
  const uint64_t clusters = side.clusters.size();
  const auto write_halves = [&](const std::string& name, std::vector<HalfBits> TensorBtfCluster::*own, uint64_t rank) {
    const std::vector<HalfBits> halves = joined(side, own);
    file.tensors[name] = tensor_of(halves, {clusters, halves.size() / clusters / rank, rank});
  };
  write_halves(part.view(), &TensorBtfCluster::view, side.rank.view);
  write_halves(part.light(), &TensorBtfCluster::light, side.rank.light);
  write_halves(part.color(), &TensorBtfCluster::color, side.rank.color);
  write_halves(part.core(), &TensorBtfCluster::core, uint64_t{side.rank.view} * side.rank.light * side.rank.color);
  file.tensors[part.scales()] = scales_tensor(joined(side, &TensorBtfCluster::scale), {clusters, side.rank.texel});
  for (size_t l = 0; l < side.levels.size(); ++l) {
    const TensorLevel& level = side.levels[l];
    const uint32_t width = level.width, height = level.height;
    if (!level.relief.empty()) file.tensors[part.relief(l)] = tensor_of(level.relief, {height, width});
    file.tensors[part.members(l)] = byte_maps(level.member, side.members, width, height);
    file.tensors[part.bytes(l)] = byte_maps(level.value, uint64_t{side.members} * side.rank.texel, width, height);
  }
}

/// An extent of a part's shape, from 1 to `most`.
uint32_t extent_of(const ModelFields& fields, const std::string& part, size_t dimensions, size_t dimension,
                   size_t most) {
  const Tensor& tensor = fields.tensor(part);
  if (tensor.shape.size() != dimensions) {
    fields.fail("the part " + part + " must have " + std::to_string(dimensions) + " dimensions.");
  }
  const uint64_t extent = tensor.shape[dimension];
  if (extent >= 1 && extent <= most) return static_cast<uint32_t>(extent);
  fields.fail("the part " + part + " has " + std::to_string(extent) + " entries along dimension " +
              std::to_string(dimension) + "; it must have 1 to " + std::to_string(most) + ".");
}

void check_ranks(const ModelFields& fields, const TensorSideParts& part, const TensorSide& side) {
  for (const uint32_t rank : {side.rank.texel, side.rank.light}) {
    if (side.clusters.size() * padded_rank(rank) <= TensorBtf::kMaxClusterRanks) continue;
    fields.fail(part.core() + " has " + std::to_string(side.clusters.size()) + " clusters of rank " +
                std::to_string(rank) + "; clusters times rank, rounded up to a multiple of " +
                std::to_string(kRankPadding) + ", must be at most " + std::to_string(TensorBtf::kMaxClusterRanks) +
                ".");
  }
}

/// Number of directions on the side. Throws if there are none.
uint64_t directions_of(const ModelFields& fields, const std::vector<PolarAngles>& set, bool below, const char* what) {
  const size_t count = directions_on_side(set, below).size();
  if (count == 0) {
    fields.fail(std::string("btf.sides has a side ") + (below ? "below" : "above") +
                " the plane, but velour.btf.index has no " + what + " there.");
  }
  return count;
}

void read_factors(const ModelFields& fields, const TensorSideParts& part, const PairLayout& layout, TensorSide& side) {
  side.clusters.resize(extent_of(fields, part.core(), 3, 0, TensorBtf::kMaxClusters));
  side.rank = {extent_of(fields, part.core(), 3, 1, TensorBtf::kMaxRank),
               extent_of(fields, part.view(), 3, 2, TensorBtf::kMaxRank),
               extent_of(fields, part.light(), 3, 2, TensorBtf::kMaxRank), extent_of(fields, part.color(), 3, 2, 3)};
  check_ranks(fields, part, side);
  const uint64_t clusters = side.clusters.size(), view = side.rank.view, light = side.rank.light,
                 color = side.rank.color, views = directions_of(fields, layout.views(), side.view_below, "view"),
                 lights = directions_of(fields, layout.lights(), side.light_below, "light");
  const auto read = [&](const std::string& name, const std::vector<uint64_t>& shape,
                        std::vector<HalfBits> TensorBtfCluster::*own) {
    split(shaped_halves(fields, name, shape), own, side);
  };
  read(part.view(), {clusters, views, view}, &TensorBtfCluster::view);
  read(part.light(), {clusters, lights, light}, &TensorBtfCluster::light);
  read(part.color(), {clusters, 3, color}, &TensorBtfCluster::color);
  read(part.core(), {clusters, side.rank.texel, view * light * color}, &TensorBtfCluster::core);
  split(read_scales(fields, part.scales(), {clusters, side.rank.texel}), &TensorBtfCluster::scale, side);
}

/// Checks that the members of each texel are distinct, existing clusters.
void check_members(const ModelFields& fields, const std::string& part, const TensorLevel& level,
                   const TensorSide& side) {
  const size_t texels = size_t{level.width} * level.height;
  const auto place = [&](size_t t, size_t k) { return k * texels + t; };  // in the part
  for (size_t t = 0; t < texels; ++t) {
    const uint8_t* member = level.member.data() + t * side.members;
    for (size_t k = 0; k < side.members; ++k) {
      const bool again = std::find(member, member + k, member[k]) != member + k;
      if (member[k] < side.clusters.size() && !again) continue;
      fields.fail_at(part, place(t, k), static_cast<float>(member[k]) / 256,
                     again ? "a cluster that does not occur before it" : "the index of a cluster, divided by 256");
    }
  }
}

TensorLevel read_level(const ModelFields& fields, const TensorSideParts& part, size_t number, uint32_t width,
                       uint32_t height, const TensorSide& side) {
  TensorLevel level{width, height, {}, {}, {}};
  if (fields.has(part.relief(number))) level.relief = shaped_halves(fields, part.relief(number), {height, width});
  level.member = read_byte_maps(fields, part.members(number), side.members, width, height);
  check_members(fields, part.members(number), level, side);
  level.value = read_byte_maps(fields, part.bytes(number), uint64_t{side.members} * side.rank.texel, width, height);
  return level;
}

TensorSide read_side(const ModelFields& fields, const TensorSideParts& part, const BtfFrame& frame,
                     const SideTable::Place& place) {
  TensorSide side;
  side.view_below = place.view_below;
  side.light_below = place.light_below;
  read_factors(fields, part, frame.layout, side);
  side.members = extent_of(fields, part.members(0), 3, 0, std::min(side.clusters.size(), TensorBtf::kMaxMembers));
  uint32_t width = frame.grid.width, height = frame.grid.height;
  for (;; width = half_of(width), height = half_of(height)) {
    side.levels.push_back(read_level(fields, part, side.levels.size(), width, height, side));
    if (width == 1 && height == 1) return side;
  }
}

}  // namespace

void write_tensor_btf(const TensorBtf& btf, TensorFile& file) {
  write_btf_frame({btf.layout, btf.grid, btf.companding, btf.axes}, file);
  write_side_table(side_table(btf), file);
  for (size_t s = 0; s < btf.sides.size(); ++s) write_side(btf.sides[s], TensorSideParts(s), file);
}

TensorBtf read_tensor_btf(const ModelFields& fields) {
  const BtfFrame frame = read_btf_frame(fields);
  TensorBtf btf{frame.layout, frame.grid, frame.companding, frame.axes, {}};
  SideTable table = read_side_table(fields);
  for (const SideTable::Place& place : table.sides) {
    btf.sides.push_back(read_side(fields, TensorSideParts(btf.sides.size()), frame, place));
  }
  btf.shared = std::move(table.shared);
  return btf;
}

}  // namespace velour
