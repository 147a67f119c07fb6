#include "model/records.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "base/json_fields.h"
#include "model/file/record_json.h"

namespace velour {

namespace {

constexpr std::array<std::string_view, 3> kQualities{"good", "fair", "poor"};
constexpr std::array<std::string_view, 10> kReasons{"",
                                                    "grazing_views",
                                                    "highlights",
                                                    "brightness",
                                                    "color",
                                                    "everywhere",
                                                    "measurement_noise",
                                                    "unresolved_highlights",
                                                    "anisotropic_samples",
                                                    "held_out_samples"};

}  // namespace

nlohmann::ordered_json verdict_json(const Verdict& verdict) {
  using Json = nlohmann::ordered_json;
  const std::string_view reason = kReasons[static_cast<size_t>(verdict.reason)];
  return {{"quality", kQualities[static_cast<size_t>(verdict.quality)]},
          {"flip_mean", four_digits(verdict.flip_mean)},
          {"flip_95", four_digits(verdict.flip_95)},
          {"reason", reason.empty() ? Json(nullptr) : Json(reason)},
          {"value", four_digits(verdict.value)}};
}

Verdict parse_verdict(const nlohmann::ordered_json& json, const std::string& where) {
  const JsonSource source{where, "the model file is damaged. Copy it again, or fit the model again."};
  if (!json.is_object()) throw Error(Status::bad_data, where + " is not an object; " + source.remedy);
  const JsonFields fields(json, source);
  const auto quality = std::ranges::find(kQualities, fields.text("quality"));
  if (quality == kQualities.end()) fields.fail("quality", "good, fair or poor");
  Verdict verdict;
  verdict.quality = static_cast<LookQuality>(quality - kQualities.begin());
  verdict.flip_mean = fields.number("flip_mean");
  verdict.flip_95 = fields.number("flip_95");
  verdict.value = fields.number("value");
  if (fields.at("reason").is_null()) return verdict;
  const auto reason = std::ranges::find(kReasons, fields.text("reason"));
  if (reason != kReasons.end()) verdict.reason = static_cast<LookReason>(reason - kReasons.begin());
  return verdict;
}

using Json = JsonFields::Json;

namespace {

constexpr size_t kMaxTrials = 100, kMaxShapes = 1000;

std::vector<SizeTrial> parse_trials(const Json& json, const JsonFields& record, const JsonSource& source) {
  if (!json.is_array() || json.size() > kMaxTrials) record.fail("search", "a list of at most 100 fits");
  std::vector<SizeTrial> trials;
  for (const Json& entry : json) {
    if (!entry.is_object()) record.fail("search", "a list of fits");
    const JsonFields fields(entry, source, "search.");
    trials.push_back({static_cast<int>(fields.whole("coefficients", 1u << 30)),
                      fields.whole("parameter_bytes", uint64_t{1} << 53), fields.number("expected"),
                      fields.number("relative_l2")});
  }
  return trials;
}

std::vector<ShapeTrial> parse_shapes(const Json& json, const JsonFields& record, const JsonSource& source) {
  if (!json.is_array() || json.size() > kMaxShapes) record.fail("shapes", "a list of at most 1000 shapes");
  std::vector<ShapeTrial> shapes;
  for (const Json& entry : json) {
    if (!entry.is_object()) record.fail("shapes", "a list of shapes");
    const JsonFields fields(entry, source, "shapes.");
    const auto number = [&](const char* key) { return static_cast<uint32_t>(fields.whole(key, 1u << 16)); };
    shapes.push_back({number("clusters"),
                      number("members"),
                      {number("texel_rank"), number("view_rank"), number("light_rank"), number("color_rank")},
                      fields.whole("parameter_bytes", uint64_t{1} << 53),
                      fields.number("expected")});
  }
  return shapes;
}

}  // namespace

nlohmann::ordered_json shapes_json(const std::vector<ShapeTrial>& shapes) {
  Json json = Json::array();
  for (const ShapeTrial& s : shapes) {
    json.push_back({{"clusters", s.clusters},
                    {"members", s.members},
                    {"texel_rank", s.rank[0]},
                    {"view_rank", s.rank[1]},
                    {"light_rank", s.rank[2]},
                    {"color_rank", s.rank[3]},
                    {"parameter_bytes", s.parameter_bytes},
                    {"expected", four_digits(s.expected)}});
  }
  return json;
}

nlohmann::ordered_json trials_json(const std::vector<SizeTrial>& trials) {
  Json json = Json::array();
  for (const SizeTrial& t : trials) {
    json.push_back({{"coefficients", t.coefficients},
                    {"parameter_bytes", t.parameter_bytes},
                    {"expected", four_digits(t.expected)},
                    {"relative_l2", four_digits(t.relative_l2)}});
  }
  return json;
}

std::string btf_record_json(const BtfRecord& record) {
  Json json = {{"method", record.method}, {"psnr", record.psnr},           {"ser", record.ser},
               {"p99", record.p99},       {"raw_bytes", record.raw_bytes}, {"seed", record.seed}};
  put_warnings(record.warnings, json);
  if (record.psnr_held_out) json["psnr_held_out"] = *record.psnr_held_out;
  json["relative_l2"] = record.relative_l2;
  json["tolerance"] = record.tolerance;
  if (!record.order.points.empty()) json["order"] = order_json(record.order);
  if (!record.search.empty()) json["search"] = trials_json(record.search);
  if (!record.shapes.empty()) json["shapes"] = shapes_json(record.shapes);
  if (record.verdict) json["verdict"] = verdict_json(*record.verdict);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);  // paths may not be UTF-8
}

BtfRecord parse_btf_record(const std::string& text, const std::string& where) {
  const JsonSource source{where, "the model file is damaged. Copy it again, or fit the model again."};
  const Json json = parse_json(text);
  if (!json.is_object()) throw Error(Status::bad_data, where + " is not a JSON object; " + source.remedy);
  const JsonFields fields(json, source);
  BtfRecord record;
  record.method = fields.text("method");
  record.psnr = fields.number("psnr");
  record.ser = fields.number("ser");
  record.p99 = fields.number("p99");
  record.raw_bytes = fields.whole("raw_bytes", uint64_t{1} << 53);
  record.seed = fields.whole("seed", ~uint64_t{0});
  if (fields.has("psnr_held_out")) record.psnr_held_out = fields.number("psnr_held_out");
  if (fields.has("relative_l2")) record.relative_l2 = fields.number("relative_l2");
  if (fields.has("tolerance")) record.tolerance = fields.number("tolerance");
  if (fields.has("order")) record.order = parse_order(fields.at("order"), where + ": 'order'");
  if (fields.has("search")) record.search = parse_trials(fields.at("search"), fields, source);
  if (fields.has("shapes")) record.shapes = parse_shapes(fields.at("shapes"), fields, source);
  if (fields.has("verdict")) record.verdict = parse_verdict(fields.at("verdict"), where + ": 'verdict'");
  record.warnings = parse_warnings(json, where);
  return record;
}

}  // namespace velour
