#include "model/parametric_file.h"

#include "brdf/model/parametric_brdf.h"

namespace velour {
namespace {

constexpr char kIsotropic[] = "velour.isotropic", kCells[] = "velour.cells";
// Integer degrees; absent in models of all views.
constexpr char kFirstView[] = "velour.first_view", kLastView[] = "velour.last_view";
constexpr char kSymmetric[] = "velour.symmetric";  // absent: false
constexpr char kSpace[] = "lobes.space", kControl[] = "lobes.control", kNone[] = "lobes.none";

std::vector<LobeSpace> read_spaces(const ModelFields& fields) {
  const Tensor& t = fields.rows(kSpace, 1);
  if (t.data.size() > ParametricBrdf::kMaxLobes) {
    fields.fail(std::string(kSpace) + " has " + std::to_string(t.data.size()) + " lobes; a model has at most " +
                std::to_string(ParametricBrdf::kMaxLobes) + ".");
  }
  std::vector<LobeSpace> out;
  for (size_t i = 0; i < t.data.size(); ++i) {
    const bool half = t.data[i] == static_cast<float>(LobeSpace::half);
    if (!half && t.data[i] != static_cast<float>(LobeSpace::light)) {
      fields.fail_at(kSpace, i, t.data[i], "0 (light directions) or 1 (half vectors)");
    }
    out.push_back(half ? LobeSpace::half : LobeSpace::light);
  }
  return out;
}

std::string range_text(const ParameterRange& range) {
  return std::to_string(range.least) + " to " + std::to_string(range.most) + " (" + range.name + ")";
}

/// The control values of `brdf`, whose lobes and spline are already set.
std::vector<float> read_control(const ModelFields& fields, const ParametricBrdf& brdf) {
  const Tensor& t = fields.tensor(kControl);
  const auto nodes = static_cast<uint64_t>(brdf.spline().node_count());
  const auto parameters = static_cast<uint64_t>(brdf.parameter_count());
  if (t.shape != std::vector<uint64_t>{nodes, parameters, brdf.space.size()}) {
    fields.fail("the part " + std::string(kControl) + " must have the shape [" + std::to_string(nodes) + ", " +
                std::to_string(parameters) + ", " + std::to_string(brdf.space.size()) + "]: nodes for " + kCells +
                ", " + "parameters, lobes in " + kSpace + ".");
  }
  for (size_t i = 0; i < t.data.size(); ++i) {
    const ParameterRange range = parameter_range(static_cast<int>(i / brdf.space.size() % parameters));
    if (!range.holds(t.data[i])) fields.fail_at(kControl, i, t.data[i], range_text(range));
  }
  return t.data;
}

}  // namespace

void write_parametric(const ParametricBrdf& brdf, TensorFile& file) {
  file.attributes[kIsotropic] = boolean_text(brdf.isotropic);
  file.attributes[kCells] = std::to_string(brdf.cells);
  file.attributes["velour.units"] = "f in 1/sr, linear Rec. 709; natural logarithms; radians";
  if (brdf.symmetric) file.attributes[kSymmetric] = boolean_text(true);
  if (!brdf.views.whole()) {
    file.attributes[kFirstView] = std::to_string(brdf.views.begin);
    file.attributes[kLastView] = std::to_string(brdf.views.end);
  }
  const auto lobes = static_cast<uint64_t>(brdf.lobe_count());
  if (lobes == 0) {  // a black model: OpenEXR allows neither empty parts nor files without parts
    file.tensors[kNone] = {{}, {0.0f}, Precision::halves};
    return;
  }
  Tensor& space = file.tensors[kSpace] = {{lobes}, {}, Precision::halves};
  for (const LobeSpace s : brdf.space) space.data.push_back(static_cast<float>(s));
  file.tensors[kControl] = {
      {static_cast<uint64_t>(brdf.spline().node_count()), static_cast<uint64_t>(brdf.parameter_count()), lobes},
      brdf.control,
      Precision::halves};
}

ParametricBrdf read_parametric(const ModelFields& fields) {
  ParametricBrdf brdf;
  brdf.isotropic = fields.boolean(kIsotropic);
  brdf.cells = fields.integer(kCells, 1, ViewSpline::kMaxCells);
  brdf.symmetric = !fields.attribute_or_empty(kSymmetric).empty() && fields.boolean(kSymmetric);
  if (!fields.attribute_or_empty(kFirstView).empty()) {
    brdf.views.begin = fields.integer(kFirstView, 0, 89);
    brdf.views.end = fields.integer(kLastView, brdf.views.begin + 1, 90);
  }
  if (!fields.has(kSpace) && !fields.has(kControl)) {
    fields.tensor(kNone);
    return brdf;
  }
  brdf.space = read_spaces(fields);
  brdf.control = read_control(fields, brdf);
  return brdf;
}

}  // namespace velour
