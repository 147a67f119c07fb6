#include "model/file/model_file.h"

#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "base/file.h"
#include "image/tensors/exr_tensors.h"
#include "model/file/model_parts.h"
#include "model/file/record_json.h"

namespace velour {
namespace {

constexpr char kFormatVersion[] = "1.9";
constexpr int kMajorVersion = 1;
constexpr char kKind[] = "model";
constexpr char kScene[] = "velour.scene", kBtf[] = "velour.btf.record";
constexpr uint64_t kMaxFileBytes = uint64_t{1} << 30;

// One overload per kind of model.

constexpr char kPerView[] = "scattered", kParametric[] = "parametric", kFactored[] = "factored-btf",
               kSrbf[] = "srbf-btf", kTensor[] = "tensor-btf";
const char* kind_of(const PerViewBrdf&) { return kPerView; }
const char* kind_of(const ParametricBrdf&) { return kParametric; }
const char* kind_of(const FactoredBtf&) { return kFactored; }
const char* kind_of(const SrbfBtf&) { return kSrbf; }
const char* kind_of(const TensorBtf&) { return kTensor; }

void write_body(const PerViewBrdf& brdf, TensorFile& file) { write_per_view(brdf, file); }
void write_body(const ParametricBrdf& brdf, TensorFile& file) { write_parametric(brdf, file); }
void write_body(const FactoredBtf& btf, TensorFile& file) { write_factored(btf, file); }
void write_body(const SrbfBtf& btf, TensorFile& file) { write_srbf_btf(btf, file); }
void write_body(const TensorBtf& btf, TensorFile& file) { write_tensor_btf(btf, file); }

ModelBody read_body(const ModelFields& fields) {
  const std::string& kind = fields.attribute("velour.model");
  if (kind == kPerView) return read_per_view(fields);
  if (kind == kParametric) return read_parametric(fields);
  if (kind == kFactored) return read_factored(fields);
  if (kind == kSrbf) return read_srbf_btf(fields);
  if (kind == kTensor) return read_tensor_btf(fields);
  throw Error(Status::unsupported, fields.name() + ": velour.model is '" + kind +
                                       "', a kind of model that this Velour does not support. Use a newer Velour.");
}

void check_version(const ModelFields& fields) {
  const std::string& text = fields.attribute("velour.format_version");
  int major = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), major);
  if (error != std::errc() || major < 1 || (end != text.data() + text.size() && *end != '.')) {
    fields.fail("velour.format_version is '" + text + "'; it must be like " + kFormatVersion + ".");
  }
  if (major > kMajorVersion) {
    throw Error(Status::unsupported, fields.name() + ": the model file has format version " + text +
                                         " of a newer Velour; this Velour reads up to version " +
                                         std::to_string(kMajorVersion) + ". Use a newer Velour.");
  }
}

}  // namespace

const char* model_kind(const Model& model) {
  return std::visit([](const auto& brdf) { return kind_of(brdf); }, model.body);
}

bool is_btf(const Model& model) {
  return std::visit([]<typename Body>(const Body&) { return BtfBody<Body>; }, model.body);
}

const TexelGrid* grid_of(const Model& model) {
  if (!is_btf(model)) return nullptr;
  return with_btf(model.body, [](const auto& btf) { return &btf.grid; });
}

uint64_t parameter_bytes(const ModelBody& body) {
  return std::visit([](const auto& b) { return b.parameter_bytes(); }, body);
}

bool is_reduced(const Model& model) {
  return model.scene && parameter_bytes(model.body) < model.scene->full_parameter_bytes;
}

std::vector<uint8_t> encode_model(const Model& model) {
  TensorFile file;
  file.attributes = {{"velour.kind", kKind},
                     {"velour.format_version", kFormatVersion},
                     {"velour.model", model_kind(model)},
                     {"velour.fit", fit_record_json(model.fit)},
                     {"velour.source.name", model.source.name},
                     {"velour.source.format", model.source.format},
                     {"velour.source.sha256", model.source.sha256}};
  if (model.scene) file.attributes[kScene] = scene_record_json(*model.scene);
  if (model.btf) file.attributes[kBtf] = btf_record_json(*model.btf);
  if (model.shell) write_shell(*model.shell, file);
  std::visit([&](const auto& brdf) { write_body(brdf, file); }, model.body);
  return encode_tensors(file);
}

Model decode_model(std::span<const uint8_t> bytes, const std::string& name) {
  if (!looks_like_exr(bytes)) {
    throw Error(Status::bad_data,
                name + " is not a Velour model (it does not begin like an OpenEXR file). Choose a .velour file.");
  }
  const TensorLimits limits{{"btf.", "lobes.", "views.", "shell."}, usual_max_bytes(bytes.size())};
  const ModelFields fields(decode_tensors(bytes, name, limits), name);
  if (fields.attribute("velour.kind") != kKind) {
    fields.fail("velour.kind is '" + fields.attribute("velour.kind") + "'; a model file has 'model'.");
  }
  check_version(fields);
  Model model;
  model.body = read_body(fields);
  model.fit = parse_fit_record(fields.attribute("velour.fit"), name + ": velour.fit");
  model.source = {fields.attribute_or_empty("velour.source.name"), fields.attribute_or_empty("velour.source.format"),
                  fields.attribute_or_empty("velour.source.sha256")};
  const std::string scene = fields.attribute_or_empty(kScene);
  if (!scene.empty()) model.scene = parse_scene_record(scene, name + ": " + kScene);
  if (is_btf(model)) model.btf = parse_btf_record(fields.attribute(kBtf), name + ": " + kBtf);
  model.shell = read_shell(fields);
  const TexelGrid* grid = model.scene ? grid_of(model) : nullptr;
  if (grid && (model.scene->full_texels[0] < grid->width || model.scene->full_texels[1] < grid->height)) {
    fields.fail(std::string(kScene) + ": full_texels is smaller than the size of the model; the file is damaged.");
  }
  const auto* brdf = std::get_if<ParametricBrdf>(&model.body);
  if (brdf && !brdf->views.whole() && !model.scene) {
    fields.fail(std::string(kScene) + " is missing, but the model covers only some views; the file is damaged.");
  }
  return model;
}

void save_model(const Model& model, const std::string& path) { write_file(path, encode_model(model)); }

Model load_model(const std::string& path) { return decode_model(read_file(path, kMaxFileBytes), path); }

bool is_model_file(const std::string& path) {
  // The kind is in the header of the first part, well before any pixels.
  const std::vector<uint8_t> head = read_file_head(path, size_t{1} << 20);
  if (!looks_like_exr(head)) return false;
  constexpr char kAttribute[] = "velour.kind\0string\0\5\0\0\0model";  // name, type, length, text: OpenEXR's layout
  return std::search(head.begin(), head.end(), kAttribute, kAttribute + sizeof kAttribute - 1) != head.end();
}

}  // namespace velour
