#include "model/file/model_parts.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_fields.h"

namespace velour {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kAttribute[] = "velour.shell", kPart[] = "shell.distance";
constexpr double kHighest = 1000;  // largest height or length, in tile widths

/// Reads keys of the attribute; every message names the key.
class ShellJson {
 public:
  ShellJson(const ModelFields& fields, const std::string& text) : fields_(fields) {
    json_ = parse_json(text);
    if (!json_.is_object()) fields.fail(std::string(kAttribute) + " is not a JSON object; the model file is damaged.");
  }

  bool has(const char* key) const { return json_.contains(key); }
  double number(const char* key, double least, double most) const {
    if (json_.contains(key) && json_[key].is_number()) {
      const double value = json_[key].get<double>();
      if (value >= least && value <= most) return value;
    }
    fail(key, "a number from " + std::to_string(least) + " to " + std::to_string(most));
  }
  bool boolean(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_boolean()) fail(key, "true or false");
    return json_[key].get<bool>();
  }
  std::string text(const char* key) const {
    if (!json_.contains(key) || !json_[key].is_string()) fail(key, "a string");
    return json_[key].get<std::string>();
  }
  [[noreturn]] void fail(const char* key, const std::string& wanted) const {
    fields_.fail(std::string(kAttribute) + ": " + key + " must be " + wanted + "; the model file is damaged.");
  }

 private:
  const ModelFields& fields_;
  Json json_;
};

uint32_t side(const ModelFields& fields, uint64_t points, uint32_t most, const char* axis) {
  if (points >= 2 && points <= most) return static_cast<uint32_t>(points);
  fields.fail(std::string(kPart) + " has " + std::to_string(points) + " points along " + axis + "; it must have 2 to " +
              std::to_string(most) + ".");
}

}  // namespace

void write_shell(const ModelShell& shell, TensorFile& file) {
  const VotfVolume& v = *shell.volume;
  Json json = {{"bottom", v.bottom}, {"top", v.top},       {"reference", v.reference},   {"aspect", v.aspect},
               {"reach", v.reach},   {"closed", v.closed}, {"tile_width", v.tile_width}, {"source", shell.source}};
  if (shell.errors) json.update(Json{{"coverage", shell.errors->coverage}, {"wrong", shell.errors->wrong}});
  file.attributes[kAttribute] = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  file.tensors[kPart] = {{v.depth, v.height, v.width}, {v.distance.begin(), v.distance.end()}, Precision::halves};
}

std::optional<ModelShell> read_shell(const ModelFields& fields) {
  const std::string text = fields.attribute_or_empty(kAttribute);
  if (text.empty()) return std::nullopt;
  const ShellJson json(fields, text);
  auto volume = std::make_shared<VotfVolume>();
  VotfVolume& v = *volume;
  const auto length = [&](const char* key, double least) {
    return static_cast<float>(json.number(key, least, kHighest));
  };
  v.bottom = length("bottom", -kHighest);
  v.top = length("top", -kHighest);
  if (!(v.top > v.bottom)) json.fail("top", "above bottom");
  v.reference = length("reference", -kHighest);
  v.aspect = length("aspect", 1 / kHighest);
  v.reach = length("reach", 1e-6);
  v.closed = json.boolean("closed");
  v.tile_width = length("tile_width", 0);
  const Tensor& part = fields.tensor(kPart);
  if (part.shape.size() != 3) fields.fail(std::string(kPart) + " must have three dimensions.");
  v.depth = side(fields, part.shape[0], VotfVolume::kMaxDepth, "z");
  v.height = side(fields, part.shape[1], VotfVolume::kMaxSide, "y");
  v.width = side(fields, part.shape[2], VotfVolume::kMaxSide, "x");
  v.distance.reserve(part.data.size());
  for (size_t i = 0; i < part.data.size(); ++i) {
    const float value = part.data[i];
    if (!(value >= 0 && value <= 255 && value == std::floor(value))) {
      fields.fail_at(kPart, i, value, "an integer from 0 to 255");
    }
    v.distance.push_back(static_cast<uint8_t>(value));
  }
  ModelShell shell{std::move(volume), json.text("source")};
  if (json.has("coverage")) shell.errors = {json.number("coverage", 0, 1), json.number("wrong", 0, 1)};
  return shell;
}

}  // namespace velour
