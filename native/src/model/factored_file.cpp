#include "model/factored_file.h"

#include <cmath>

#include "image/half_image.h"
#include "model/btf_sides.h"

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

}  // namespace velour
