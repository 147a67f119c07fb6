#include <algorithm>
#include <cmath>
#include <span>

#include "brdf/eval/per_view_lobes.h"
#include "brdf/model/parametric_brdf.h"
#include "math/srbf/lobe_mixture.h"
#include "model/file/model_parts.h"

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

namespace {

constexpr char kLightSpace[] = "light";
constexpr double kUnitTolerance = 1e-3;  // of a stored direction's length
constexpr float kMaxBandwidth = 1e9f, kMaxCoefficient = 1e12f;

Tensor vectors(std::span<const Vec3> values) {
  Tensor t{{values.size(), 3}, {}};
  for (const Vec3& v : values) t.data.insert(t.data.end(), {v.x, v.y, v.z});
  return t;
}

Tensor scalars(std::vector<float> values) {
  const uint64_t n = values.size();
  return {{n}, std::move(values)};
}

std::vector<Vec3> read_directions(const ModelFields& fields, const std::string& part) {
  const Tensor& t = fields.rows(part, 3);
  std::vector<Vec3> out;
  for (size_t i = 0; i < t.data.size(); i += 3) {
    const Vec3 v(t.data[i], t.data[i + 1], t.data[i + 2]);
    const double length = glm::length(Vec3d(v));
    if (!(std::abs(length - 1) <= kUnitTolerance)) {
      fields.fail_at(part, i / 3, static_cast<float>(length), "a vector of length 1");
    }
    // Leave vectors that are unit up to rounding alone, so that reading and writing a file again preserves its bits.
    out.push_back(std::abs(length - 1) > 1e-6 ? Vec3(Vec3d(v) / length) : v);
  }
  return out;
}

std::vector<float> read_bandwidths(const ModelFields& fields, Kernel kernel, size_t count) {
  const Tensor& t = fields.rows("lobes.bandwidth", 1);
  if (t.data.size() != count)
    fields.fail("lobes.bandwidth and lobes.center differ in length; the model file is damaged.");
  for (size_t i = 0; i < count; ++i) {
    const float b = t.data[i];
    if (kernel == Kernel::gaussian && !(b > 0 && b <= kMaxBandwidth)) {
      fields.fail_at("lobes.bandwidth", i, b, "above 0 and at most 1e9");
    }
    if (kernel == Kernel::abel_poisson && !(b > 0 && b < 1)) {
      fields.fail_at("lobes.bandwidth", i, b, "between 0 and 1");
    }
  }
  return t.data;
}

/// Reads `count` non-negative colors from `part`, as many as `whose` has entries.
std::vector<Rgb> read_coefficients(const ModelFields& fields, const std::string& part, size_t count,
                                   const char* whose) {
  const Tensor& t = fields.rows(part, 3);
  if (t.data.size() != 3 * count) fields.fail(part + " and " + whose + " differ in length; the model file is damaged.");
  std::vector<Rgb> out;
  for (size_t i = 0; i < t.data.size(); ++i) {
    if (!(t.data[i] >= 0 && t.data[i] <= kMaxCoefficient)) {
      fields.fail_at(part, i / 3, t.data[i], "a finite number of at least 0");
    }
    if (i % 3 == 2) out.emplace_back(t.data[i - 2], t.data[i - 1], t.data[i]);
  }
  return out;
}

std::vector<uint32_t> read_first_lobes(const ModelFields& fields, size_t views, size_t lobes, int neighbors) {
  const Tensor& t = fields.rows("views.lobe_count", 1);
  if (t.data.size() != views)
    fields.fail("views.lobe_count and views.direction differ in length; the model file is damaged.");
  const int most = LobeMixture::kCapacity / neighbors;
  std::vector<uint32_t> first{0};
  for (size_t i = 0; i < views; ++i) {
    const float n = t.data[i];
    if (!(n >= 0 && n <= static_cast<float>(most)) || n != std::floor(n)) {
      const std::string wanted = "an integer from 0 to " + std::to_string(most);
      fields.fail_at("views.lobe_count", i, n, wanted.c_str());
    }
    first.push_back(first.back() + static_cast<uint32_t>(n));
  }
  if (first.back() != lobes) {
    fields.fail("views.lobe_count adds up to " + std::to_string(first.back()) + ", but the model has " +
                std::to_string(lobes) + " lobes; the model file is damaged.");
  }
  return first;
}

void check_views(const ModelFields& fields, const PerViewBrdf& brdf) {
  const std::string part = "views.direction";
  for (size_t i = 0; i < brdf.views.size(); ++i) {
    const Vec3& v = brdf.views[i];
    if (v.z < 0) fields.fail_at(part, i, v.z, "on or above the horizon (z of at least 0)");
    if (!brdf.isotropic) continue;
    if (std::abs(v.y) > kUnitTolerance || v.x < -kUnitTolerance)
      fields.fail_at(part, i, v.y, "on the meridian phi = 0");
    if (i > 0 && v.z > brdf.views[i - 1].z) fields.fail_at(part, i, v.z, "in the order of increasing polar angles");
  }
}

Kernel read_kernel(const ModelFields& fields) {
  const std::string& text = fields.attribute("velour.kernel");
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    if (text == kernel_name(kernel)) return kernel;
  }
  fields.fail("velour.kernel is '" + text + "'; this Velour supports " + kernel_name(Kernel::gaussian) + " and " +
              kernel_name(Kernel::abel_poisson) + ".");
}

}  // namespace

void write_per_view(const PerViewBrdf& brdf, TensorFile& file) {
  file.attributes["velour.kernel"] = kernel_name(brdf.kernel);
  file.attributes["velour.parameterisation"] = kLightSpace;
  file.attributes["velour.isotropic"] = boolean_text(brdf.isotropic);
  file.attributes["velour.align_views"] = boolean_text(brdf.align_views);
  file.attributes["velour.neighbors"] = std::to_string(brdf.default_neighbors);
  file.attributes["velour.units"] =
      "coefficients of f cos(theta_l) in 1/sr, linear Rec. 709; unit directions, +z normal, +x tangent";
  std::vector<float> counts;
  for (size_t i = 0; i < brdf.views.size(); ++i) {
    counts.push_back(static_cast<float>(brdf.first_lobe[i + 1] - brdf.first_lobe[i]));
  }
  file.tensors["views.direction"] = vectors(brdf.views);
  file.tensors["views.lobe_count"] = scalars(std::move(counts));
  if (!brdf.diffuse.empty()) file.tensors["views.diffuse"] = vectors(brdf.diffuse);
  if (brdf.center.empty()) return;  // a black model has no lobes, and OpenEXR allows no empty parts
  file.tensors["lobes.center"] = vectors(brdf.center);
  file.tensors["lobes.bandwidth"] = scalars(brdf.bandwidth);
  file.tensors["lobes.coefficient"] = vectors(brdf.coefficient);
}

PerViewBrdf read_per_view(const ModelFields& fields) {
  if (fields.attribute("velour.parameterisation") != kLightSpace) {
    fields.fail("velour.parameterisation is '" + fields.attribute("velour.parameterisation") +
                "'; this Velour supports only 'light'.");
  }
  PerViewBrdf brdf;
  brdf.kernel = read_kernel(fields);
  brdf.isotropic = fields.boolean("velour.isotropic");
  brdf.align_views = fields.boolean("velour.align_views");
  brdf.default_neighbors = fields.integer("velour.neighbors", 1, kMaxNeighbors);
  brdf.views = read_directions(fields, "views.direction");
  check_views(fields, brdf);
  if (fields.has("views.diffuse")) {
    brdf.diffuse = read_coefficients(fields, "views.diffuse", brdf.views.size(), "views.direction");
  }
  if (fields.has("lobes.center") || fields.has("lobes.bandwidth") || fields.has("lobes.coefficient")) {
    brdf.center = read_directions(fields, "lobes.center");
    brdf.bandwidth = read_bandwidths(fields, brdf.kernel, brdf.center.size());
    brdf.coefficient = read_coefficients(fields, "lobes.coefficient", brdf.center.size(), "lobes.center");
  }
  brdf.first_lobe = read_first_lobes(fields, brdf.views.size(), brdf.center.size(), brdf.default_neighbors);
  return brdf;
}

}  // namespace velour
