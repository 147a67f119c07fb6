#include "model/verdict.h"

#include <algorithm>
#include <array>
#include <string_view>
#include "base/error.h"
#include "base/json_fields.h"

namespace velour {

namespace {

constexpr std::array<std::string_view, 3> kQualities{"good", "fair", "poor"};
constexpr std::array<std::string_view, 7> kReasons{"",      "grazing_views", "highlights",       "brightness",
                                                   "color", "everywhere",    "measurement_noise"};

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

}  // namespace velour
