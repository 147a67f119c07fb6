// Every wrong call answers with the right status and a sentence, and changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>

#include "velour/velour.h"

namespace {

#define EXPECT_STATUS(expected, call)                    \
  do {                                                   \
    EXPECT_EQ(expected, (call)) << vlr_last_error();     \
    EXPECT_GT(std::string(vlr_last_error()).size(), 5u); \
  } while (false)

TEST(Misuse, NullArgumentsAreNamed) {
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_measurement_load(nullptr, nullptr));
  EXPECT_NE(std::string(vlr_last_error()).find("path"), std::string::npos);
  vlr_measurement* measurement = nullptr;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_measurement_load("x", nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_measurement_info_json(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_measurement_eval(measurement, nullptr, 1, nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_model_load(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_model_load_memory(nullptr, 0, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_model_save(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_model_roughened(nullptr, 0, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_light_map_create_job(nullptr, nullptr, 0, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_lobe_rows_create_job(nullptr, 0, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_principled_rows_create_job(nullptr, 0, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_btf_maps_create_job(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shell_maps_create_job(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_job_result_table(nullptr, nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_job_start(nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_job_wait(nullptr, 0, nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_create(nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_commit(nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_render_create_job(nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_fit_create_job(nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_texture_create(1, 1, 1, nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_texture_load(nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_add_textured_material(nullptr, nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_create(nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_add_layer(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_add_measured_layer(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_weigh_layer(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_add_shader_material(nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_capture_create_job(nullptr, nullptr, "x", nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_directions(nullptr, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_observation_create(nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_tile_kinds_json(nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_tile_create(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_tile_desc(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_tile_material(nullptr, 0, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_tile_info_json(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_observation_load(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_observation_save(nullptr, "x"));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_observation_merge(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_observation_info_json(nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_observe_create_job(nullptr, 0, nullptr, nullptr));
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_job_result_observation(nullptr, nullptr));
}

TEST(Misuse, FreeingNothingIsFine) {
  vlr_measurement_free(nullptr);
  vlr_model_free(nullptr);
  vlr_scene_free(nullptr);
  vlr_texture_free(nullptr);
  vlr_shader_free(nullptr);
  vlr_observation_free(nullptr);
  vlr_tile_free(nullptr);
  vlr_job_free(nullptr);
}

TEST(Misuse, ShadersAreChecked) {
  vlr_shader* shader = nullptr;
  ASSERT_EQ(VLR_OK, vlr_shader_create(&shader));
  vlr_factor_desc factor;
  vlr_factor_desc_init(&factor);
  EXPECT_STATUS(VLR_INVALID_STATE, vlr_shader_weigh_layer(shader, &factor));
  vlr_layer_desc layer;
  vlr_layer_desc_init(&layer);
  layer.kind = VLR_LAYER_TRANSLUCENT + 1;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_add_layer(shader, &layer));
  EXPECT_NE(std::string(vlr_last_error()).find("vlr_layer_desc.kind is 8"), std::string::npos);
  ASSERT_EQ(VLR_OK, vlr_shader_add_layer(shader, nullptr));
  factor.kind = VLR_FACTOR_LEVEL + 1;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_weigh_layer(shader, &factor));
  factor.kind = VLR_FACTOR_GAIN;
  factor.value = NAN;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_weigh_layer(shader, &factor));
  factor.value = 2;
  EXPECT_EQ(VLR_OK, vlr_shader_weigh_layer(shader, &factor));
  factor.kind = VLR_FACTOR_TINT;
  factor.color[1] = NAN;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_weigh_layer(shader, &factor));
  factor.kind = VLR_FACTOR_LEVEL;
  EXPECT_EQ(VLR_OK, vlr_shader_weigh_layer(shader, &factor));
  for (const float last : {-1.0f, INFINITY, NAN}) {
    factor.level[2] = last;
    EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_weigh_layer(shader, &factor));
  }
  vlr_measured_layer_desc measured;
  vlr_measured_layer_desc_init(&measured);
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_add_measured_layer(shader, &measured));
  measured.map[0] = measured.map[4] = 0;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_add_measured_layer(shader, &measured));
  EXPECT_NE(std::string(vlr_last_error()).find("vlr_measured_layer_desc.map"), std::string::npos);
  measured.map[0] = measured.map[4] = 1;
  measured.aspect = 0;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_shader_add_measured_layer(shader, &measured));
  EXPECT_NE(std::string(vlr_last_error()).find("vlr_measured_layer_desc.aspect"), std::string::npos);
  vlr_scene* scene = nullptr;
  uint32_t material = 7;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene));
  EXPECT_EQ(VLR_OK, vlr_scene_add_shader_material(scene, shader, &material));
  EXPECT_EQ(0u, material);
  vlr_shader_free(shader);
  vlr_scene_free(scene);
}

TEST(Misuse, MissingFilesAreNamed) {
  vlr_measurement* measurement = nullptr;
  EXPECT_STATUS(VLR_IO, vlr_measurement_load("/nowhere/at all.binary", &measurement));
  EXPECT_NE(std::string(vlr_last_error()).find("/nowhere/at all.binary"), std::string::npos);
  EXPECT_EQ(measurement, nullptr);
  vlr_model* model = nullptr;
  EXPECT_STATUS(VLR_IO, vlr_model_load("/nowhere/x.velour", &model));
  vlr_observation* observation = nullptr;
  EXPECT_STATUS(VLR_IO, vlr_observation_load("/nowhere/x.json", &observation));
  const char* json = nullptr;
  EXPECT_STATUS(VLR_IO, vlr_file_info_json("/nowhere/x", &json));
}

TEST(Misuse, RubbishInMemoryIsNotAModel) {
  vlr_model* model = nullptr;
  const std::string rubbish(1000, 'x');
  EXPECT_STATUS(VLR_BAD_DATA, vlr_model_load_memory(rubbish.data(), rubbish.size(), "packed.velour", &model));
  EXPECT_NE(std::string(vlr_last_error()).find("packed.velour"), std::string::npos);
  EXPECT_EQ(model, nullptr);
}

TEST(Misuse, ErrorsBelongToTheirThread) {
  vlr_model* model = nullptr;
  EXPECT_STATUS(VLR_IO, vlr_model_load("/nowhere/mine.velour", &model));
  std::thread([] { EXPECT_STREQ(vlr_last_error(), ""); }).join();
  EXPECT_NE(std::string(vlr_last_error()).find("mine"), std::string::npos);
}

TEST(Misuse, StructsOfOtherSizesAreRefused) {
  vlr_scene* scene = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene));
  vlr_light_desc light;
  vlr_light_desc_init(&light);
  light.struct_size += 4;
  EXPECT_STATUS(VLR_VERSION_MISMATCH, vlr_scene_add_light(scene, &light));
  light.struct_size = 0;
  EXPECT_STATUS(VLR_VERSION_MISMATCH, vlr_scene_add_light(scene, &light));
  vlr_scene_free(scene);
  vlr_principled_desc surface;
  vlr_principled_desc_init(&surface);
  for (const uint32_t size : {uint32_t{0}, surface.struct_size + 4}) {
    surface.struct_size = size;
    vlr_job* job = nullptr;
    EXPECT_STATUS(VLR_VERSION_MISMATCH, vlr_principled_rows_create_job(&surface, 1, &job));
    vlr_job_free(job);
    vlr_principled_desc_init(&surface);
  }
}

TEST(Misuse, MaterialsThatAreNotThereCannotBeReplaced) {
  vlr_scene* scene = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene));
  vlr_principled_desc desc;
  vlr_principled_desc_init(&desc);
  uint32_t number = 0;
  for (int materials = 0; materials < 3; ++materials) {
    for (const uint32_t none : {uint32_t{2}, UINT32_MAX - 1, UINT32_MAX}) {
      EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_scene_replace_material(scene, none));
    }
    ASSERT_EQ(VLR_OK, vlr_scene_add_principled_material(scene, &desc, &number)) << vlr_last_error();
  }
  EXPECT_EQ(VLR_OK, vlr_scene_replace_material(scene, 1)) << vlr_last_error();
  vlr_scene_free(scene);
}

TEST(Misuse, AnUnknownInstructionSetIsRefused) {
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_select_simd("ENIAC"));
  EXPECT_EQ(VLR_OK, vlr_select_simd("auto"));
}

TEST(Misuse, PicturesAreChecked) {
  const float pixel[4] = {0, 0, 0, 1};
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_image_write("x.png", 0, 1, 4, pixel));
  double rmse = 0, relmse = 0;
  EXPECT_STATUS(VLR_INVALID_ARGUMENT, vlr_image_compare(0, 4, pixel, pixel, &rmse, &relmse));
}

}  // namespace
