// Files of reduced models of BTFs that lie about their scene.
#include "model/records.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/tensors/exr_tensors.h"
#include "model/file/model_file.h"
#include "support/example_btf.h"

namespace velour::scene_record_test {
namespace {

using Json = nlohmann::ordered_json;

/// 6 x 4 texels of 12 x 8.
Model reduced() {
  Model model{test::example_factored(), {}, {"weave", "velour-btf", std::string(64, 'b')}};
  model.btf.emplace().method = "svd";
  SceneRecord& scene = model.scene.emplace();
  scene.full_parameter_bytes = 1u << 20;
  scene.full_texels = {12, 8};
  return model;
}

/// What is said to a file whose record has `value` as `key`; "" when it is accepted.
std::string complaint(const char* key, const Json& value) {
  TensorFile file = decode_tensors(encode_model(reduced()), "test.velour");
  Json json = Json::parse(file.attributes["velour.scene"]);
  json[key] = value;
  file.attributes["velour.scene"] = json.dump();
  try {
    decode_model(encode_tensors(file), "test.velour");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_named(const std::string& complaint, const char* key) {
  EXPECT_EQ(complaint.find("test.velour: velour.scene"), 0u) << complaint;
  EXPECT_NE(complaint.find(key), std::string::npos) << complaint;
}

TEST(SceneRecordOfABtf, AGoodOneIsAccepted) {
  EXPECT_EQ(complaint("full_texels", Json::array({12, 8})), "");
  EXPECT_TRUE(is_reduced(decode_model(encode_model(reduced()), "test.velour")));
}

TEST(SceneRecordOfABtf, TexelsThatCannotBeAreNamed) {
  for (const char* bad : {"[12]", "[0, 8]", "[12, -8]", "[12, 8.5]", "\"12 x 8\"", "[12, 1073741824]", "[5, 8]", "[]",
                          "null", "[[12], 8]"}) {
    expect_named(complaint("full_texels", Json::parse(bad)), "full_texels");
  }
}

TEST(SceneRecordOfABtf, WhetherItKnowsSeenViewsAlone) {
  EXPECT_EQ(complaint("seen_views_alone", true), "");
  for (const char* bad : {"1", "null", "\"yes\""}) {
    expect_named(complaint("seen_views_alone", Json::parse(bad)), "seen_views_alone");
  }
}

TEST(SceneRecordOfABtf, DirectionsSurviveARoundTrip) {
  Model model = reduced();
  add_view(model.scene->domain.surface.views, direction(0.7f, 2), 0.125);
  add_view(model.scene->domain.surface.views, direction(2.5f, 5), 3);
  const Model back = decode_model(encode_model(model), "test.velour");
  EXPECT_EQ(back.scene->domain.surface.views.weight, model.scene->domain.surface.views.weight);
}

TEST(SceneRecordOfABtf, DirectionsThatCannotBeAreNamed) {
  for (const char* bad : {"[2592]", "[-1]", "[0.5]", "\"all\"", "[[1]]"}) {
    expect_named(complaint("direction_bins", Json::parse(bad)), "direction_bins");
  }
  expect_named(complaint("direction_bins", Json::array({1})), "direction_weights");
}

TEST(SceneRecordOfABtf, WeightsThatCannotBeAreNamed) {
  for (const char* key : {"footprint_weights", "tile_weights"}) {
    expect_named(complaint(key, Json::array({1, 2})), key);
    expect_named(complaint(key, nullptr), key);
    expect_named(complaint(key, std::vector<double>(key[0] == 'f' ? 128 : 256, -1)), key);
    expect_named(complaint(key, std::vector<std::string>(key[0] == 'f' ? 128 : 256, "1")), key);
  }
}

}  // namespace
}  // namespace velour::scene_record_test
