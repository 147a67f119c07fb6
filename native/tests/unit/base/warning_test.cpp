// Warnings in model files: codes and values survive, sentences of earlier versions are kept, and damage is named.
#include "base/warning.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "base/error.h"
#include "support/warnings.h"

namespace velour::warning_test {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Warning> examples() {
  return {warning<WarningCode::few_samples>({{"samples", uint64_t{40}}, {"judged", uint64_t{5}}, {"held_out", true}}),
          warning<WarningCode::black_model>(),
          warning<WarningCode::model_albedo_above_one>(
              {{"albedo", 1.25}, {"view", 60.0}, {"azimuth", std::vector<double>{-90.0}}, {"measured", 0.5}}),
          warning<WarningCode::views_not_covered>({{"views", std::vector<double>{75, 85}}}),
          warning<WarningCode::channels_ignored>(
              {{"file", "a.exr"}, {"layer", ""}, {"channels", std::vector<std::string>{"AO.R", "\"Z\""}}})};
}

Json record_of(const std::vector<Warning>& warnings) {
  Json record;
  put_warnings(warnings, record);
  return Json::parse(record.dump());
}

TEST(Warning, KindsHaveDifferentKeysAndNames) {
  std::set<std::string_view> keys;
  for (const WarningKind& kind : kWarningKinds) EXPECT_TRUE(keys.insert(kind.key).second) << kind.key;
  EXPECT_TRUE(kind_of(WarningCode::few_samples).has("judged"));
  EXPECT_FALSE(kind_of(WarningCode::few_samples).has("sample")) << "a part of a name";
  EXPECT_FALSE(kind_of(WarningCode::few_samples).has("")) << "control";
}

TEST(Warning, SurvivesARoundTrip) {
  EXPECT_EQ(parse_warnings(record_of(examples()), "record"), examples());
  EXPECT_TRUE(record_of(examples()).at("warnings").empty()) << "sentences are for earlier versions";
}

TEST(Warning, FractionsHaveFourDigits) {
  const auto json = warnings_json({warning<WarningCode::model_not_reciprocal>({{"change", 1.0 / 3}})});
  EXPECT_EQ(json[0]["values"]["change"], 0.3333);
}

TEST(Warning, SentencesOfEarlierVersionsAreKept) {
  const Json record = {{"warnings", {"view 60 degrees: relative L2 0.03 exceeds 0.02"}}};
  const std::vector<Warning> warnings = parse_warnings(record, "record");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].code, WarningCode::stored_sentence);
  EXPECT_EQ(record_of(warnings).at("warnings"), record.at("warnings"));
  EXPECT_TRUE(parse_warnings(Json::object(), "record").empty());
}

TEST(Warning, CodesOfLaterVersionsAreNamed) {
  Json record = record_of(examples());
  record["warning_codes"][1] = {{"code", "too_shiny"}, {"values", {{"gloss", 2}}}};
  const Warning unknown = parse_warnings(record, "record").at(1);
  EXPECT_EQ(unknown, warning<WarningCode::unknown_warning>({{"code", "too_shiny"}}));
}

TEST(Warning, DamageIsNamed) {
  const auto complaint = [](const std::function<void(Json&)>& damage) -> std::string {
    Json record = record_of(examples());
    damage(record);
    try {
      parse_warnings(record, "metal.velour: velour.fit");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint([](Json&) {}), "") << "control";
  const std::vector<std::function<void(Json&)>> damages = {
      [](Json& r) { r["warning_codes"] = 3; },
      [](Json& r) { r["warning_codes"][0] = "few_samples"; },
      [](Json& r) { r["warning_codes"][0].erase("values"); },
      [](Json& r) { r["warning_codes"][0]["code"] = 7; },
      [](Json& r) { r["warning_codes"][0]["values"].erase("judged"); },
      [](Json& r) { r["warning_codes"][0]["values"]["more"] = 1; },
      [](Json& r) { r["warning_codes"][0]["values"]["samples"] = nullptr; },
      [](Json& r) { r["warning_codes"][0]["values"]["samples"] = Json::object(); },
      [](Json& r) {
        r["warning_codes"][3]["values"]["views"] = {75, "85"};
      },
      [](Json& r) { r["warning_codes"][3]["values"]["views"] = std::vector<int>(1001); },
      [](Json& r) { r["warning_codes"] = std::vector<Json>(1001, r["warning_codes"][0]); }};
  for (size_t i = 0; i < damages.size(); ++i) {
    EXPECT_EQ(complaint(damages[i]).find("metal.velour: velour.fit: 'warning_codes' must be"), 0u) << i;
  }
  EXPECT_NE(complaint([](Json& r) { r["warnings"] = {1}; }).find("'warnings'"), std::string::npos);
}

}  // namespace
}  // namespace velour::warning_test
