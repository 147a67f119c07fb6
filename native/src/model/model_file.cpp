#include "model/model_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "file/file.h"
#include "image/exr_tensors.h"
#include "job/error.h"
#include "material/scattered_material.h"
#include "material/view_neighbors.h"
#include "model/fit_record_json.h"
#include "srbf/lobe_mixture.h"

namespace velour {
namespace {

constexpr char kFormatVersion[] = "1.0";
constexpr int kMajorVersion = 1;
constexpr char kKind[] = "model", kLightSpace[] = "light";
constexpr uint64_t kMaxFileBytes = uint64_t{1} << 30;
constexpr double kUnitTolerance = 1e-3;  // of a stored direction's length
constexpr float kMaxBandwidth = 1e9f, kMaxCoefficient = 1e12f;

// ---- writing ----

Tensor vectors(std::span<const Vec3> values) {
  Tensor t{{values.size(), 3}, {}};
  for (const Vec3& v : values) t.data.insert(t.data.end(), {v.x, v.y, v.z});
  return t;
}

Tensor scalars(std::vector<float> values) {
  const uint64_t n = values.size();
  return {{n}, std::move(values)};
}

void add_scattered(const ScatteredBrdf& brdf, TensorFile& file) {
  file.attributes["velour.kernel"] = kernel_name(brdf.kernel);
  file.attributes["velour.parameterisation"] = kLightSpace;
  file.attributes["velour.isotropic"] = brdf.isotropic ? "true" : "false";
  file.attributes["velour.align_views"] = brdf.align_views ? "true" : "false";
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
  if (brdf.center.empty()) return;  // a black model has no lobes, and OpenEXR no empty parts
  file.tensors["lobes.center"] = vectors(brdf.center);
  file.tensors["lobes.bandwidth"] = scalars(brdf.bandwidth);
  file.tensors["lobes.coefficient"] = vectors(brdf.coefficient);
}

// ---- reading ----

/// A decoded file with its name, for sentences.
class Fields {
 public:
  Fields(TensorFile file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& what) const { throw Error(Status::bad_data, name_ + ": " + what); }

  const std::string& attribute(const std::string& key) const {
    const auto found = file_.attributes.find(key);
    if (found == file_.attributes.end()) fail("the attribute " + key + " is missing; this is not a Velour model.");
    return found->second;
  }
  std::string attribute_or_empty(const std::string& key) const {
    const auto found = file_.attributes.find(key);
    return found == file_.attributes.end() ? std::string() : found->second;
  }
  bool boolean(const std::string& key) const {
    const std::string& text = attribute(key);
    if (text != "true" && text != "false") fail(key + " is '" + text + "'; it must be true or false.");
    return text == "true";
  }
  int integer(const std::string& key, int least, int most) const {
    const std::string& text = attribute(key);
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) {
      fail(key + " is '" + text + "'; it must be " + std::to_string(least) + " to " + std::to_string(most) + ".");
    }
    return value;
  }
  bool has(const std::string& part) const { return file_.tensors.contains(part); }
  /// [rows] or [rows, columns] for columns > 1.
  const Tensor& tensor(const std::string& part, uint64_t columns) const {
    const auto found = file_.tensors.find(part);
    if (found == file_.tensors.end()) fail("the part " + part + " is missing.");
    const auto& shape = found->second.shape;
    const bool fits = columns == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == columns;
    if (!fits) fail("the part " + part + " must have the shape [n" + (columns == 1 ? "]." : ", 3]."));
    return found->second;
  }

 private:
  TensorFile file_;
  std::string name_;
};

/// "part[i] is v; it must be ..."
[[noreturn]] void fail_at(const Fields& fields, const std::string& part, size_t i, float value, const char* wanted) {
  fields.fail(part + "[" + std::to_string(i) + "] is " + std::to_string(value) + "; it must be " + wanted + ".");
}

std::vector<Vec3> read_directions(const Fields& fields, const std::string& part) {
  const Tensor& t = fields.tensor(part, 3);
  std::vector<Vec3> out;
  for (size_t i = 0; i < t.data.size(); i += 3) {
    const Vec3 v(t.data[i], t.data[i + 1], t.data[i + 2]);
    const double length = glm::length(Vec3d(v));
    if (!(std::abs(length - 1) <= kUnitTolerance)) {
      fail_at(fields, part, i / 3, static_cast<float>(length), "a direction of length 1");
    }
    // What is unit to rounding is left alone, so that a file that is read and written again keeps its bits.
    out.push_back(std::abs(length - 1) > 1e-6 ? Vec3(Vec3d(v) / length) : v);
  }
  return out;
}

std::vector<float> read_bandwidths(const Fields& fields, Kernel kernel, size_t count) {
  const Tensor& t = fields.tensor("lobes.bandwidth", 1);
  if (t.data.size() != count) fields.fail("lobes.bandwidth and lobes.center disagree in length.");
  for (size_t i = 0; i < count; ++i) {
    const float b = t.data[i];
    if (kernel == Kernel::gaussian && !(b > 0 && b <= kMaxBandwidth)) {
      fail_at(fields, "lobes.bandwidth", i, b, "above 0 and at most 1e9");
    }
    if (kernel == Kernel::abel_poisson && !(b > 0 && b < 1)) {
      fail_at(fields, "lobes.bandwidth", i, b, "between 0 and 1");
    }
  }
  return t.data;
}

/// Non-negative colours of `part`, `count` of them, as many as there are of `whose`.
std::vector<Rgb> read_coefficients(const Fields& fields, const std::string& part, size_t count, const char* whose) {
  const Tensor& t = fields.tensor(part, 3);
  if (t.data.size() != 3 * count) fields.fail(part + " and " + whose + " disagree in length.");
  std::vector<Rgb> out;
  for (size_t i = 0; i < t.data.size(); ++i) {
    if (!(t.data[i] >= 0 && t.data[i] <= kMaxCoefficient)) {
      fail_at(fields, part, i / 3, t.data[i], "a finite number of at least 0");
    }
    if (i % 3 == 2) out.emplace_back(t.data[i - 2], t.data[i - 1], t.data[i]);
  }
  return out;
}

std::vector<uint32_t> read_first_lobes(const Fields& fields, size_t views, size_t lobes, int neighbors) {
  const Tensor& t = fields.tensor("views.lobe_count", 1);
  if (t.data.size() != views) fields.fail("views.lobe_count and views.direction disagree in length.");
  const int most = LobeMixture::kCapacity / neighbors;
  std::vector<uint32_t> first{0};
  for (size_t i = 0; i < views; ++i) {
    const float n = t.data[i];
    if (!(n >= 0 && n <= static_cast<float>(most)) || n != std::floor(n)) {
      const std::string wanted = "a whole number of at most " + std::to_string(most);
      fail_at(fields, "views.lobe_count", i, n, wanted.c_str());
    }
    first.push_back(first.back() + static_cast<uint32_t>(n));
  }
  if (first.back() != lobes) {
    fields.fail("views.lobe_count sums to " + std::to_string(first.back()) + ", but there are " +
                std::to_string(lobes) + " lobes.");
  }
  return first;
}

void check_views(const Fields& fields, const ScatteredBrdf& brdf) {
  const std::string part = "views.direction";
  for (size_t i = 0; i < brdf.views.size(); ++i) {
    const Vec3& v = brdf.views[i];
    if (v.z < 0) fail_at(fields, part, i, v.z, "on or above the horizon (z of at least 0)");
    if (!brdf.isotropic) continue;
    if (std::abs(v.y) > kUnitTolerance || v.x < -kUnitTolerance)
      fail_at(fields, part, i, v.y, "on the meridian phi = 0");
    if (i > 0 && v.z > brdf.views[i - 1].z) fail_at(fields, part, i, v.z, "in the order of the polar angle");
  }
}

Kernel read_kernel(const Fields& fields) {
  const std::string& text = fields.attribute("velour.kernel");
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    if (text == kernel_name(kernel)) return kernel;
  }
  fields.fail("velour.kernel is '" + text + "'; this Velour knows " + kernel_name(Kernel::gaussian) + " and " +
              kernel_name(Kernel::abel_poisson) + ".");
}

ScatteredBrdf read_scattered(const Fields& fields) {
  if (fields.attribute("velour.parameterisation") != kLightSpace) {
    fields.fail("velour.parameterisation is '" + fields.attribute("velour.parameterisation") +
                "'; this Velour knows only 'light'.");
  }
  ScatteredBrdf brdf;
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

void check_version(const Fields& fields, const std::string& name) {
  const std::string& text = fields.attribute("velour.format_version");
  int major = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), major);
  if (error != std::errc() || major < 1 || (end != text.data() + text.size() && *end != '.')) {
    fields.fail("velour.format_version is '" + text + "'; it must be like " + kFormatVersion + ".");
  }
  if (major > kMajorVersion) {
    throw Error(Status::unsupported, name + ": the model file has format version " + text +
                                         ", which a newer Velour wrote; this one reads up to version " +
                                         std::to_string(kMajorVersion) + ". Use the newer Velour.");
  }
}

}  // namespace

const char* model_kind(const Model&) { return "scattered"; }

std::vector<uint8_t> encode_model(const Model& model) {
  TensorFile file;
  file.attributes = {{"velour.kind", kKind},
                     {"velour.format_version", kFormatVersion},
                     {"velour.model", model_kind(model)},
                     {"velour.fit", fit_record_json(model.fit)},
                     {"velour.source.name", model.source.name},
                     {"velour.source.format", model.source.format},
                     {"velour.source.sha256", model.source.sha256}};
  add_scattered(std::get<ScatteredBrdf>(model.body), file);
  return encode_tensors(file);
}

Model decode_model(std::span<const uint8_t> bytes, const std::string& name) {
  if (!looks_like_exr(bytes)) {
    throw Error(Status::bad_data, name + " is not a Velour model (it does not begin like an OpenEXR file).");
  }
  const Fields fields(decode_tensors(bytes, name), name);
  if (fields.attribute("velour.kind") != kKind) {
    fields.fail("velour.kind is '" + fields.attribute("velour.kind") + "', not a model.");
  }
  check_version(fields, name);
  if (fields.attribute("velour.model") != "scattered") {
    throw Error(Status::unsupported, name + ": velour.model is '" + fields.attribute("velour.model") +
                                         "', a kind of model that this Velour does not know. Use a newer one.");
  }
  Model model;
  model.body = read_scattered(fields);
  model.fit = parse_fit_record(fields.attribute("velour.fit"), name + ": velour.fit");
  model.source = {fields.attribute_or_empty("velour.source.name"), fields.attribute_or_empty("velour.source.format"),
                  fields.attribute_or_empty("velour.source.sha256")};
  return model;
}

void save_model(const Model& model, const std::string& path) { write_file(path, encode_model(model)); }

Model load_model(const std::string& path) { return decode_model(read_file(path, kMaxFileBytes), path); }

bool is_model_file(const std::string& path) {
  // The kind stands in the header of the first part, long before any pixels.
  const std::vector<uint8_t> head = read_file_head(path, size_t{1} << 20);
  if (!looks_like_exr(head)) return false;
  constexpr char kAttribute[] = "velour.kind\0string\0\5\0\0\0model";  // name, type, length, text: OpenEXR's layout
  return std::search(head.begin(), head.end(), kAttribute, kAttribute + sizeof kAttribute - 1) != head.end();
}

std::shared_ptr<const Material> make_material(std::shared_ptr<const Model> model, int neighbors) {
  const auto& brdf = std::get<ScatteredBrdf>(model->body);
  // Shares the ownership of the model instead of copying its lobes.
  return make_scattered_material(std::shared_ptr<const ScatteredBrdf>(std::move(model), &brdf), neighbors);
}

}  // namespace velour
