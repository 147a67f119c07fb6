// A tile through the C API: its arrays go straight into a scene.
#include <gtest/gtest.h>

#include <string>

#include "velour/velour.h"

namespace {

struct TestTile {
  explicit TestTile(const char* kind, uint32_t count = 0) {
    vlr_tile_options options;
    vlr_tile_options_init(&options);
    options.kind = kind;
    options.count = count;
    EXPECT_EQ(VLR_OK, vlr_tile_create(&options, &tile)) << vlr_last_error();
  }
  ~TestTile() { vlr_tile_free(tile); }
  TestTile(const TestTile&) = delete;
  TestTile& operator=(const TestTile&) = delete;

  vlr_tile* tile = nullptr;
};

TEST(CTile, GoesIntoAScene) {
  const TestTile made("weave", 2);
  vlr_mesh_desc desc = {};
  desc.struct_size = sizeof desc;
  ASSERT_EQ(VLR_OK, vlr_tile_desc(made.tile, &desc)) << vlr_last_error();
  EXPECT_EQ(desc.struct_size, sizeof desc);
  EXPECT_EQ(desc.triangle_count, 2u * 2 * 32 * 16 * 2);
  vlr_scene* scene = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene)) << vlr_last_error();
  uint32_t mesh = 0, dropped = 1;
  EXPECT_EQ(VLR_OK, vlr_scene_add_mesh(scene, &desc, &mesh, &dropped)) << vlr_last_error();
  EXPECT_EQ(dropped, 0u);
  vlr_scene_free(scene);
}

TEST(CTile, SaysTheMaterialsOfItsSlots) {
  const TestTile made("gravel");
  vlr_principled_desc material;
  vlr_principled_desc_init(&material);
  ASSERT_EQ(VLR_OK, vlr_tile_material(made.tile, 1, &material)) << vlr_last_error();
  EXPECT_EQ(material.specular, 0.0f);
  EXPECT_GT(material.base_color[0], 0.4f);
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_tile_material(made.tile, 4, &material));
  EXPECT_NE(std::string(vlr_last_error()).find("gravel"), std::string::npos);
}

TEST(CTile, DefaultsAreAWeave) {
  vlr_tile* tile = nullptr;
  ASSERT_EQ(VLR_OK, vlr_tile_create(nullptr, &tile)) << vlr_last_error();
  const char* json = nullptr;
  EXPECT_EQ(VLR_OK, vlr_tile_info_json(tile, &json));
  EXPECT_NE(std::string(json).find(R"("kind":"weave","period":[0.002)"), std::string::npos) << json;
  vlr_tile_free(tile);
}

TEST(CTile, ListsTheKinds) {
  const char* json = nullptr;
  ASSERT_EQ(VLR_OK, vlr_tile_kinds_json(&json));
  for (const char* kind :
       {"weave", "twill", "net", "chainmail", "gravel", "corduroy", "satin", "knit", "velvet", "leather", "denim"}) {
    EXPECT_NE(std::string(json).find('"' + std::string(kind) + '"'), std::string::npos) << kind;
  }
}

TEST(CTile, RefusesStructsOfAnotherSize) {
  const TestTile made("net");
  vlr_mesh_desc desc = {};
  EXPECT_EQ(VLR_VERSION_MISMATCH, vlr_tile_desc(made.tile, &desc));
  desc.struct_size = sizeof desc + 8;
  EXPECT_EQ(VLR_VERSION_MISMATCH, vlr_tile_desc(made.tile, &desc));
  EXPECT_NE(std::string(vlr_last_error()).find("vlr_mesh_desc"), std::string::npos);
}

TEST(CTile, RefusesUnknownKinds) {
  vlr_tile_options options;
  vlr_tile_options_init(&options);
  vlr_tile* tile = nullptr;
  options.kind = "felt";
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_tile_create(&options, &tile));
  options.kind = nullptr;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_tile_create(&options, &tile));
  options.kind = "weave";
  options.count = 0xffffffffu;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_tile_create(&options, &tile));
  EXPECT_EQ(tile, nullptr);
}

}  // namespace
