#include "btf/formats/btf_index.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/json_fields.h"

namespace velour {
namespace {

using Json = JsonFields::Json;

constexpr const char* kFormat = "velour-btf";
constexpr uint64_t kVersion = 1;
constexpr uint64_t kMaxCount = uint64_t{1} << 53;  // larger integers are not exact in every JSON reader

Json directions_json(const std::vector<PolarAngles>& directions) {
  Json list = Json::array();
  for (const PolarAngles& d : directions) list.push_back({d.theta, d.phi});
  return list;
}

Json pairs_json(const PairLayout& layout) {
  Json list = Json::array();
  for (size_t v = 0; v < layout.views().size(); ++v) {
    Json lights = Json::array();
    for (uint64_t p = layout.first(v); p < layout.first(v + 1); ++p) lights.push_back(layout.light_of(p));
    list.push_back(std::move(lights));
  }
  return list;
}

Json options_json(const std::string& options) {
  Json json = parse_json(options);
  if (!json.is_object()) throw Error(Status::invalid_argument, "The options of a BTF must be a JSON object.");
  return json;
}

bool is_positive(double value) { return value > 0 && std::isfinite(value); }

void check(const BtfIndex& index) {
  const TexelGrid& grid = index.grid;
  const auto refuse = [](const char* sentence) { throw Error(Status::invalid_argument, sentence); };
  if (grid.width == 0 || grid.height == 0 || grid.width > kMaxTexelsAlong || grid.height > kMaxTexelsAlong) {
    refuse("A BTF must have 1 to 16384 texels along each side.");
  }
  if (index.layout.views().size() > kMaxDirections || index.layout.lights().size() > kMaxDirections) {
    refuse("A BTF can have at most 4096 views and 4096 lights.");
  }
  if (grid.tile_metres && !(is_positive(grid.tile_metres->x) && is_positive(grid.tile_metres->y))) {
    refuse("The tile size of a BTF must be two positive numbers, in meters.");
  }
  if (index.shell && !(index.shell->thickness >= 0 && std::isfinite(index.shell->thickness) &&
                       std::isfinite(index.shell->reference_height))) {
    refuse("The shell of a BTF must have a finite reference height and a finite thickness of at least 0.");
  }
}

Json index_json(const BtfIndex& index) {
  const auto& tile = index.grid.tile_metres;
  Json json = {{"format", kFormat},
               {"version", kVersion},
               {"source", index.source},
               {"texels", {index.grid.width, index.grid.height}},
               {"tile_metres", tile ? Json{tile->x, tile->y} : Json(nullptr)},
               {"shell", nullptr},
               {"structure", index.structure},
               {"errors", index.errors},
               {"options", options_json(index.options)},
               {"views", directions_json(index.layout.views())},
               {"lights", directions_json(index.layout.lights())}};
  if (index.shell) {
    json["shell"] = {{"thickness", index.shell->thickness}, {"reference_height", index.shell->reference_height}};
  }
  if (!index.layout.complete()) json["pairs"] = pairs_json(index.layout);
  return json;
}

Json content_json(const BtfContent& content) {
  Json files = Json::array();
  for (const auto& view : content.views) files.push_back({{"bytes", view.bytes}, {"sha256", view.sha256}});
  return {{"values", content.counts.values},
          {"not_finite", content.counts.not_finite},
          {"negative", content.counts.negative},
          {"files", std::move(files)}};
}

const Json& list_at(const JsonFields& fields, const char* key, size_t most) {
  const Json& list = fields.at(key);
  if (!list.is_array() || list.size() > most)
    fields.fail(key, "a list of at most " + std::to_string(most) + " entries");
  return list;
}

std::array<double, 2> two(const JsonFields& fields, const char* key, const Json& json) {
  if (!json.is_array() || json.size() != 2 || !json[0].is_number() || !json[1].is_number()) {
    fields.fail(key, "a pair of numbers");
  }
  return {json[0].get<double>(), json[1].get<double>()};
}

std::vector<PolarAngles> read_directions(const JsonFields& fields, const char* key) {
  std::vector<PolarAngles> directions;
  for (const Json& entry : list_at(fields, key, kMaxDirections)) {
    const auto [theta, phi] = two(fields, key, entry);
    directions.push_back({theta, phi});
  }
  return directions;
}

std::vector<std::vector<uint32_t>> read_pairs(const JsonFields& fields) {
  std::vector<std::vector<uint32_t>> pairs;
  for (const Json& entry : list_at(fields, "pairs", kMaxDirections)) {
    if (!entry.is_array() || entry.size() > kMaxDirections)
      fields.fail("pairs", "a list of light indices for each view");
    std::vector<uint32_t>& lights = pairs.emplace_back();
    for (const Json& light : entry) {
      const bool number = light.is_number_unsigned() && light.get<uint64_t>() < kMaxDirections;
      if (!number) fields.fail("pairs", "light indices below 4096");
      lights.push_back(light.get<uint32_t>());
    }
  }
  return pairs;
}

PairLayout read_layout(const JsonFields& fields) {
  std::vector<PolarAngles> views = read_directions(fields, "views"), lights = read_directions(fields, "lights");
  if (fields.has("pairs")) return {std::move(views), std::move(lights), read_pairs(fields)};
  return {std::move(views), std::move(lights)};
}

TexelGrid read_grid(const JsonFields& fields) {
  const auto [width, height] = two(fields, "texels", fields.at("texels"));
  const auto is_size = [](double n) { return n >= 1 && n <= kMaxTexelsAlong && n == std::floor(n); };
  if (!is_size(width) || !is_size(height)) fields.fail("texels", "two whole numbers from 1 to 16384");
  TexelGrid grid{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
  if (!fields.at("tile_metres").is_null()) {
    const auto [x, y] = two(fields, "tile_metres", fields.at("tile_metres"));
    grid.tile_metres = Vec2(x, y);
  }
  return grid;
}

std::optional<Shell> read_shell(const JsonFields& fields) {
  if (fields.at("shell").is_null()) return std::nullopt;
  const JsonFields shell = fields.object("shell");
  return Shell{shell.number("thickness"), shell.number("reference_height")};
}

BtfContent read_content(const JsonFields& fields, size_t views, const JsonSource& source) {
  BtfContent content;
  content.counts = {fields.whole("values", kMaxCount), fields.whole("not_finite", kMaxCount),
                    fields.whole("negative", kMaxCount)};
  const Json& files = list_at(fields, "files", views);
  if (files.size() != views) fields.fail("files", "a list of " + std::to_string(views) + " files");
  for (const Json& file : files) {
    if (!file.is_object()) fields.fail("files", "a list of objects");
    const JsonFields entry(file, source, "content.files.");
    content.views.push_back({entry.whole("bytes", kMaxCount), entry.text("sha256")});
  }
  return content;
}

Json parsed(std::span<const uint8_t> bytes, const std::string& name) {
  Json json = parse_json(bytes);
  if (is_of_format(json, kFormat)) return json;
  throw Error(Status::bad_data, name + ": is not the index of a BTF (JSON with format '" + kFormat +
                                    "'); it may be truncated. Copy the whole folder again, or capture the BTF again.");
}

void check_version(const JsonFields& fields, const std::string& name) {
  const uint64_t version = fields.whole("version", std::numeric_limits<uint64_t>::max());
  if (version == kVersion) return;
  throw Error(Status::version_mismatch, name + ": the BTF has format version " + std::to_string(version) +
                                            "; this Velour reads version " + std::to_string(kVersion) +
                                            ". Use a newer Velour.");
}

BtfIndex read_index(const JsonFields& fields) {
  BtfIndex index{read_layout(fields), read_grid(fields), read_shell(fields), fields.text("source")};
  index.structure = fields.flag("structure");
  index.errors = fields.flag("errors");
  if (!fields.at("options").is_object()) fields.fail("options", "an object");
  index.options = fields.at("options").dump();
  check(index);
  return index;
}

}  // namespace

std::string encode_btf_index(const BtfIndex& index, const std::optional<BtfContent>& content) {
  check(index);
  Json json = index_json(index);
  json["content"] = content ? content_json(*content) : Json(nullptr);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

DecodedBtfIndex decode_btf_index(std::span<const uint8_t> bytes, const std::string& name) {
  const Json json = parsed(bytes, name);
  const JsonSource source{name, "the file is damaged. Copy the whole folder again, or capture the BTF again."};
  const JsonFields fields(json, source);
  check_version(fields, name);
  try {
    DecodedBtfIndex decoded{read_index(fields), std::nullopt};
    if (fields.at("content").is_null()) return decoded;
    decoded.content = read_content(fields.object("content"), decoded.index.layout.views().size(), source);
    return decoded;
  } catch (const Error& error) {
    // Errors of PairLayout and check() do not name the file.
    if (error.status() != Status::invalid_argument) throw;
    throw Error(Status::bad_data, name + ": " + error.what());
  }
}

std::optional<std::string> difference(const BtfIndex& a, const BtfIndex& b) {
  using Unordered = nlohmann::json;  // compares objects regardless of the order of their members
  if (Unordered::parse(a.options) != Unordered::parse(b.options)) return "options";
  const Json left = index_json(a), right = index_json(b);
  for (const auto& [key, value] : left.items()) {
    if (key != "options" && right.value(key, Json()) != value) return key;
  }
  for (const auto& [key, value] : right.items()) {
    if (!left.contains(key)) return key;
  }
  return std::nullopt;
}

}  // namespace velour
