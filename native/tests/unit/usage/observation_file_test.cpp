// Files of observations: round trips, and files that lie, end early or were damaged.
#include "usage/observation.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_fields.h"
#include "support/example_observation.h"
#include "support/test_data.h"

namespace velour::observation_file_test {
namespace {

using Json = nlohmann::ordered_json;

std::span<const uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// What decode_observation says to `text`; "" when it accepts it.
std::string complaint_of(const std::string& text, Status expected = Status::bad_data) {
  try {
    decode_observation(bytes_of(text), "SCENE.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), expected) << error.what();
    return error.what();
  }
  return "";
}

std::string complaint(const std::function<void(Json&)>& change) {
  Json json = Json::parse(encode_observation(test::example_observation(6)));
  change(json);
  return complaint_of(json.dump());
}

void expect_named(const std::string& complaint, const std::string& field) {
  EXPECT_EQ(complaint.find("SCENE.json"), 0u) << complaint;
  EXPECT_NE(complaint.find(field), std::string::npos) << complaint << " should name " << field;
}

/// Puts `value` at place `i` of the array of T at hits.KEY or terms.KEY.
template <typename T>
auto put(const char* group, const char* key, size_t i, T value) {
  return [=](Json& json) {
    auto bytes = *parse_base64(json[group][key].get<std::string>());
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
    json[group][key] = base64(bytes);
  };
}

TEST(ObservationFile, BitsSurviveARoundTrip) {
  auto written = test::example_observation(40);
  written.hits[3].light_density = std::numeric_limits<float>::infinity();
  written.domain.light_density = std::numeric_limits<double>::infinity();
  written.domain.view[5] = 0.1 + 0.2;
  written.light[2].g = -0.25f;
  const std::string path = test::scratch_folder() / "scene.json";
  save_observation(written, path);
  EXPECT_TRUE(is_observation_file(path));
  const auto read = load_observation(path);
  EXPECT_EQ(content_hash(read), content_hash(written));
  EXPECT_EQ(read.domain.hash, written.domain.hash);
  EXPECT_EQ(read.domain.camera_rays, written.domain.camera_rays);
  EXPECT_EQ(read.domain.frames, written.domain.frames);
  EXPECT_EQ(encode_observation(read), encode_observation(written));
}

/// An observation of a material that varies over the surface.
SceneObservation example_on_a_surface() {
  SceneObservation o = test::example_observation(6);
  for (int i = 0; i < 6; ++i) {
    add_seen(o.domain.surface, 2.3f * static_cast<float>(i), Vec2(0.15f * static_cast<float>(i)), 1);
    add_view(o.domain.surface.views, direction(0.2f * static_cast<float>(i), 1), 0.1);
  }
  o.hits[2].back = true;
  return o;
}

TEST(ObservationFile, FootprintsSurviveARoundTrip) {
  const SceneObservation written = example_on_a_surface();
  const auto read = decode_observation(bytes_of(encode_observation(written)), "SCENE.json");
  EXPECT_EQ(read.domain.surface.footprint, written.domain.surface.footprint);
  EXPECT_EQ(read.domain.surface.tile, written.domain.surface.tile);
  EXPECT_EQ(read.domain.surface.views.weight, written.domain.surface.views.weight);
  EXPECT_TRUE(read.hits[2].back);
  EXPECT_FALSE(read.hits[1].back);
  EXPECT_EQ(content_hash(read), content_hash(written));
  EXPECT_NE(content_hash(read), content_hash(test::example_observation(6)));
}

TEST(ObservationFile, DamagedFootprintsAreNamed) {
  const auto damaged = [](const std::function<void(Json&)>& change) {
    Json json = Json::parse(encode_observation(example_on_a_surface()));
    change(json["surface"]);
    return complaint_of(json.dump());
  };
  for (const char* key : {"footprint", "tile"}) {
    const std::string name = std::string("surface.") + key;
    expect_named(damaged([key](Json& json) { json.erase(key); }), name);
    expect_named(damaged([key](Json& json) { json[key].push_back(0); }), name);
    expect_named(damaged([key](Json& json) { json[key][3] = -1; }), name);
    expect_named(damaged([key](Json& json) { json[key] = "many"; }), name);
  }
  expect_named(damaged([](Json& json) { json["footprint"] = std::vector<double>(128, 1e308); }), "surface.footprint");
  expect_named(damaged([](Json& json) { json = 3; }), "surface");
}

TEST(ObservationFile, DirectionsMayBeMissingButNotDamaged) {
  const auto damaged = [](const std::function<void(Json&)>& change) {
    Json json = Json::parse(encode_observation(example_on_a_surface()));
    change(json);
    return complaint_of(json.dump());
  };
  EXPECT_EQ(damaged([](Json& json) { json["surface"].erase("views"); }), "");  // as earlier versions write them
  EXPECT_EQ(damaged([](Json& json) { json["hits"].erase("back"); }), "");
  expect_named(damaged([](Json& json) { json["surface"]["views"] = "AAAA"; }), "surface.views");
  expect_named(damaged([](Json& json) { json["surface"]["views"] = 7; }), "surface.views");
  SceneObservation negative = example_on_a_surface();
  negative.domain.surface.views.weight[7] = -0.1;
  expect_named(complaint_of(encode_observation(negative)), "surface.views");
  expect_named(damaged([](Json& json) { json["hits"]["back"] = "AAAAAAAC"; }), "hits.back");
  expect_named(damaged([](Json& json) { json["hits"]["back"] = "AAAA"; }), "hits.back");
}

TEST(ObservationFile, OfNoFrameIsAFileToo) {
  const auto read = decode_observation(bytes_of(encode_observation({})), "empty");
  EXPECT_TRUE(read.hits.empty());
  EXPECT_EQ(read.domain.frames, 0u);
}

TEST(ObservationFile, EndsEarlyAtEveryByte) {
  const std::string text = encode_observation(test::example_observation(3));
  ASSERT_EQ(text.substr(text.size() - 2), "}\n");
  for (size_t size = 0; size + 2 <= text.size(); ++size) EXPECT_NE(complaint_of(text.substr(0, size)), "") << size;
  EXPECT_EQ(complaint_of(text), "");
}

TEST(ObservationFile, OtherFilesAreNamedAsSuch) {
  for (const char* text : {"", "no JSON", "[]", "17", "{}", R"({"format": "gltf"})", R"({"format": 7})", "\xff\xfe"}) {
    expect_named(complaint_of(text), "velour observe");
  }
  expect_named(complaint_of(std::string(100000, '[')), "velour observe");
  const std::string deep = std::string(300000, '[') + std::string(300000, ']');
  expect_named(complaint_of(R"({"format": )" + deep + "}"), "velour observe");
  const auto folder = test::scratch_folder();
  write_file(folder / "x", bytes_of("{\"format\": \"gltf\"}"));
  EXPECT_FALSE(is_observation_file(folder / "x"));
}

TEST(ObservationFile, LaterVersionsAreRefused) {
  Json json = Json::parse(encode_observation(test::example_observation(1)));
  json["version"] = 2;
  expect_named(complaint_of(json.dump(), Status::version_mismatch), "version 2");
}

TEST(ObservationFile, MissingFieldsAreNamed) {
  for (const char* key : {"version", "frames", "camera_rays", "light_density", "hash", "view", "hits", "terms"}) {
    expect_named(complaint([key](Json& json) { json.erase(key); }), key);
    expect_named(complaint([key](Json& json) { json[key] = true; }), key);
  }
  for (const char* key : {"count", "key", "wv", "light_density", "terms"}) {
    expect_named(complaint([key](Json& json) { json["hits"].erase(key); }), std::string("hits.") + key);
    expect_named(complaint([key](Json& json) { json["hits"][key] = nullptr; }), std::string("hits.") + key);
  }
  for (const char* key : {"count", "wl", "light"}) {
    expect_named(complaint([key](Json& json) { json["terms"].erase(key); }), std::string("terms.") + key);
    expect_named(complaint([key](Json& json) { json["terms"][key] = "!"; }), std::string("terms.") + key);
  }
}

TEST(ObservationFile, NumbersOutOfRangeAreNamed) {
  expect_named(complaint([](Json& json) { json["frames"] = -1; }), "frames");
  expect_named(complaint([](Json& json) { json["camera_rays"] = 1.5; }), "camera_rays");
  expect_named(complaint([](Json& json) { json["camera_rays"] = 18446744073709551615u; }), "camera_rays");
  expect_named(complaint([](Json& json) { json["light_density"] = -1; }), "light_density");
  expect_named(complaint([](Json& json) { json["view"][4] = -1e-9; }), "view");
  expect_named(complaint([](Json& json) { json["view"][4] = nullptr; }), "view");
  expect_named(complaint([](Json& json) { json["view"].push_back(0); }), "view");
  expect_named(complaint([](Json& json) { json["view"] = std::vector<double>(90, 1e308); }), "view");
  expect_named(complaint([](Json& json) { json["hash"] = "12"; }), "hash");
  std::string huge = encode_observation(test::example_observation(1));
  huge.replace(huge.find("\"frames\": 1"), 11, "\"frames\": 1e999");
  expect_named(complaint_of(huge), "velour observe");
}

TEST(ObservationFile, CountsThatLieAreNamed) {
  for (const uint64_t count : {uint64_t{0}, uint64_t{5}, uint64_t{7}, uint64_t{1024}}) {
    expect_named(complaint([=](Json& json) { json["hits"]["count"] = count; }), "hits.");
  }
  for (const uint64_t count : {uint64_t{1025}, uint64_t{1} << 32, ~uint64_t{0}}) {
    expect_named(complaint([=](Json& json) { json["hits"]["count"] = count; }), "hits.count");
    expect_named(complaint([=](Json& json) { json["terms"]["count"] = uint64_t{1} << 40 | count; }), "terms.count");
  }
  expect_named(complaint([](Json& json) { json["terms"]["count"] = 3; }), "terms");
  expect_named(complaint([](Json& json) { json["terms"] = {{"count", 0}, {"wl", ""}, {"light", ""}}; }), "hits.terms");
  expect_named(complaint(put("hits", "terms", 4, 0xffffffffu)), "hits.terms");
  expect_named(complaint(put("hits", "terms", 11, 0u)), "hits.terms");
}

TEST(ObservationFile, ArraysOfNonsenseAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  expect_named(complaint(put("hits", "wv", 2, nan)), "hits.wv");
  expect_named(complaint(put("hits", "wv", 2, -0.5f)), "hits.wv");
  expect_named(complaint(put("hits", "wv", 1, 2.0f)), "hits.wv");
  expect_named(complaint(put("hits", "light_density", 0, nan)), "hits.light_density");
  expect_named(complaint(put("hits", "light_density", 0, -1.0f)), "hits.light_density");
  expect_named(complaint(put("hits", "key", 0, ~uint64_t{0})), "hits.key");
  expect_named(complaint(put("terms", "wl", 5, nan)), "terms.wl");
  expect_named(complaint(put("terms", "wl", 3, infinity)), "terms.wl");
  expect_named(complaint(put("terms", "light", 5, nan)), "terms.light");
  expect_named(complaint(put("terms", "light", 5, infinity)), "terms.light");
}

TEST(ObservationFile, DamageAnywhereIsReadOrRefused) {
  const std::string whole = encode_observation(test::example_observation(20));
  RandomStream random(5, 5, 5);
  int refused = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text = whole;
    for (int damages = 0; damages <= i % 3; ++damages) {
      text[random.next_bits() % text.size()] = static_cast<char>(random.next_bits());
    }
    try {
      const auto read = decode_observation(bytes_of(text), "SCENE.json");
      ASSERT_LE(read.hits.size(), SceneObservation::kHits);
      ASSERT_TRUE(read.hits.empty() || read.hits.back().last == read.wl.size());
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 2500);
}

TEST(ObservationFile, WeightWithoutHitsIsRefused) {
  Json json = Json::parse(encode_observation({}));
  json["view"][3] = 1.0;
  expect_named(complaint_of(json.dump()), "hits");
  expect_named(complaint([](Json& j) { j["view"] = std::vector<double>(90, 0.0); }), "hits");
}

}  // namespace
}  // namespace velour::observation_file_test
