#include "model/factored_file.h"

#include <cmath>

#include "btf/btf_index.h"

namespace velour {
namespace {

constexpr char kIndex[] = "velour.btf.index", kCompanding[] = "velour.companding";
constexpr char kAxes[] = "btf.axes", kAxis[] = "btf.axis", kPairs[] = "btf.pairs";
constexpr const char* kCompandingNames[] = {"none", "root"};

std::string level_name(size_t level) { return "btf.texels." + std::to_string(level); }

std::vector<float> floats_of(const std::vector<HalfBits>& halves) {
  std::vector<float> floats(halves.size());
  halves_to_floats(halves, floats);
  return floats;
}

/// [texel][component] to [component][texel], so that in the file every component is a picture.
std::vector<float> by_component(const TexelLevel& level, size_t components) {
  const std::vector<float> values = floats_of(level.value);
  std::vector<float> maps(values.size());
  const size_t texels = values.size() / components;
  for (size_t t = 0; t < texels; ++t) {
    for (size_t k = 0; k < components; ++k) maps[k * texels + t] = values[t * components + k];
  }
  return maps;
}

std::vector<HalfBits> checked_halves(const ModelFields& fields, const std::string& part, const Tensor& tensor) {
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    if (!std::isfinite(tensor.data[i])) fields.fail_at(part, i, tensor.data[i], "finite");
  }
  std::vector<HalfBits> halves(tensor.data.size());
  floats_to_halves(tensor.data, halves);
  return halves;
}

const Tensor& shaped(const ModelFields& fields, const std::string& part, const std::vector<uint64_t>& shape) {
  const Tensor& tensor = fields.tensor(part);
  if (tensor.shape == shape) return tensor;
  std::string text;
  for (const uint64_t extent : shape) text += (text.empty() ? "[" : ", ") + std::to_string(extent);
  fields.fail("the part " + part + " must have the shape " + text + "].");
}

FactoredBtf empty_btf(const ModelFields& fields) {
  const std::string& text = fields.attribute(kIndex);
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  const BtfIndex index = decode_btf_index(bytes, fields.name() + ": " + kIndex).index;
  if (!index.layout.complete()) fields.fail(std::string(kIndex) + " leaves out pairs; a model needs all of them.");
  FactoredBtf btf{index.layout, index.grid, {}, Mat3(1.0f), {}, {}, {}};
  const std::string& companding = fields.attribute(kCompanding);
  if (companding != kCompandingNames[0] && companding != kCompandingNames[1]) {
    fields.fail(std::string(kCompanding) + " is '" + companding + "'; it must be none or root.");
  }
  btf.companding = companding == kCompandingNames[1] ? Companding::root : Companding::none;
  return btf;
}

void read_axes(const ModelFields& fields, FactoredBtf& btf) {
  const Tensor& axes = shaped(fields, kAxes, {3, 3});
  for (size_t i = 0; i < 9; ++i) {
    const float value = axes.data[i];
    if (!(std::abs(value) <= 1.001f)) fields.fail_at(kAxes, i, value, "a component of a unit vector");
    btf.axes[static_cast<int>(i / 3)][static_cast<int>(i % 3)] = value;
  }
  const Tensor& axis = fields.rows(kAxis, 1);
  if (axis.data.size() > FactoredBtf::kMaxComponents) {
    fields.fail(std::string(kAxis) + " has " + std::to_string(axis.data.size()) + " components; a model has at most " +
                std::to_string(FactoredBtf::kMaxComponents) + ".");
  }
  float least = 0;
  for (size_t i = 0; i < axis.data.size(); ++i) {
    const float a = axis.data[i];
    if (!(a >= least && a <= 2 && a == std::floor(a))) fields.fail_at(kAxis, i, a, "0, 1 or 2, never falling");
    btf.axis.push_back(static_cast<uint8_t>(least = a));
  }
}

TexelLevel read_level(const ModelFields& fields, size_t number, uint32_t width, uint32_t height, size_t components) {
  const std::string part = level_name(number);
  const std::vector<HalfBits> maps = checked_halves(fields, part, shaped(fields, part, {components, height, width}));
  TexelLevel level{width, height, std::vector<HalfBits>(maps.size())};
  const size_t texels = maps.size() / components;
  for (size_t k = 0; k < components; ++k) {
    for (size_t t = 0; t < texels; ++t) level.value[t * components + k] = maps[k * texels + t];
  }
  return level;
}

}  // namespace

void write_factored(const FactoredBtf& btf, TensorFile& file) {
  const uint64_t components = btf.components();
  file.attributes[kIndex] = encode_btf_index({.layout = btf.layout, .grid = btf.grid}, std::nullopt);
  file.attributes[kCompanding] = kCompandingNames[static_cast<size_t>(btf.companding)];
  file.attributes["velour.units"] = "apparent BRDF in 1/sr, linear Rec. 709";
  Tensor& axes = file.tensors[kAxes] = {{3, 3}, {}, false};
  for (int i = 0; i < 9; ++i) axes.data.push_back(btf.axes[i / 3][i % 3]);
  file.tensors[kAxis] = {{components}, std::vector<float>(btf.axis.begin(), btf.axis.end()), true};
  file.tensors[kPairs] = {{btf.layout.pairs(), components}, floats_of(btf.pair_value), true};
  for (size_t l = 0; l < btf.levels.size(); ++l) {
    const TexelLevel& level = btf.levels[l];
    file.tensors[level_name(l)] = {{components, level.height, level.width}, by_component(level, components), true};
  }
}

FactoredBtf read_factored(const ModelFields& fields) {
  FactoredBtf btf = empty_btf(fields);
  read_axes(fields, btf);
  btf.pair_value = checked_halves(fields, kPairs, shaped(fields, kPairs, {btf.layout.pairs(), btf.components()}));
  uint32_t width = btf.grid.width, height = btf.grid.height;
  for (;; width = half_of(width), height = half_of(height)) {
    btf.levels.push_back(read_level(fields, btf.levels.size(), width, height, btf.components()));
    if (width == 1 && height == 1) return btf;
  }
}

}  // namespace velour
