#include "model/factored_file.h"

#include <cmath>

#include "image/half_image.h"
#include "model/btf_parts.h"

namespace velour {
namespace {

constexpr char kAxis[] = "btf.axis", kPairs[] = "btf.pairs";

std::string level_name(size_t level) { return "btf.texels." + std::to_string(level); }

std::vector<uint8_t> read_axis_numbers(const ModelFields& fields) {
  const Tensor& tensor = fields.rows(kAxis, 1);
  if (tensor.data.size() > FactoredBtf::kMaxComponents) {
    fields.fail(std::string(kAxis) + " has " + std::to_string(tensor.data.size()) +
                " components; a model has at most " + std::to_string(FactoredBtf::kMaxComponents) + ".");
  }
  std::vector<uint8_t> axis;
  float least = 0;
  for (size_t i = 0; i < tensor.data.size(); ++i) {
    const float a = tensor.data[i];
    if (!(a >= least && a <= 2 && a == std::floor(a))) fields.fail_at(kAxis, i, a, "0, 1 or 2, never falling");
    axis.push_back(static_cast<uint8_t>(least = a));
  }
  return axis;
}

}  // namespace

void write_factored(const FactoredBtf& btf, TensorFile& file) {
  const uint64_t components = btf.components();
  write_btf_frame({btf.layout, btf.grid, btf.companding, btf.axes}, file);
  file.tensors[kAxis] = {{components}, std::vector<float>(btf.axis.begin(), btf.axis.end()), true};
  file.tensors[kPairs] = tensor_of(btf.pair_value, {btf.layout.pairs(), components});
  for (size_t l = 0; l < btf.levels.size(); ++l) {
    const TexelLevel& level = btf.levels[l];
    file.tensors[level_name(l)] = maps_tensor(level.value, components, level.width, level.height);
  }
}

FactoredBtf read_factored(const ModelFields& fields) {
  const BtfFrame frame = read_btf_frame(fields);
  FactoredBtf btf{frame.layout, frame.grid, frame.companding, frame.axes, read_axis_numbers(fields), {}, {}};
  btf.pair_value = shaped_halves(fields, kPairs, {btf.layout.pairs(), btf.components()});
  uint32_t width = btf.grid.width, height = btf.grid.height;
  for (;; width = half_of(width), height = half_of(height)) {
    const std::string part = level_name(btf.levels.size());
    btf.levels.push_back({width, height, read_maps(fields, part, btf.components(), width, height)});
    if (width == 1 && height == 1) return btf;
  }
}

}  // namespace velour
