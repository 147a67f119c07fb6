// Textures through the C interface: a plane that shows its picture, and every wrong call.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "velour/velour.h"

namespace {

struct TextureHandle {
  vlr_texture* texture = nullptr;
  ~TextureHandle() { vlr_texture_free(texture); }
};

const float kPixels[] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1.0f, 0.05f, 0.15f};  // 2 x 2 x 3

vlr_texture_options options_with(int32_t vlr_texture_options::*field, int32_t value) {
  vlr_texture_options options;
  vlr_texture_options_init(&options);
  options.*field = value;
  return options;
}

void expect_refused(const vlr_texture_options& options, const char* word) {
  TextureHandle handle;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_texture_create(2, 2, 3, kPixels, &options, &handle.texture));
  EXPECT_NE(std::string(vlr_last_error()).find(word), std::string::npos) << vlr_last_error();
  EXPECT_EQ(handle.texture, nullptr);
}

TEST(Texture, OptionsAreChecked) {
  expect_refused(options_with(&vlr_texture_options::wrap, 4), "wrap is 4");
  expect_refused(options_with(&vlr_texture_options::filter, -1), "filter is -1");
  expect_refused(options_with(&vlr_texture_options::channel, 3), "channel is 3");
  expect_refused(options_with(&vlr_texture_options::channel, -2), "channel is -2");
  expect_refused(options_with(&vlr_texture_options::srgb, 1), "4 channels");
  expect_refused(options_with(&vlr_texture_options::premultiplied, 1), "have 3");
  TextureHandle handle;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_texture_create(0, 2, 3, kPixels, nullptr, &handle.texture));
  EXPECT_EQ(VLR_IO, vlr_texture_load("/nowhere/x.png", nullptr, &handle.texture));
}

TEST(Texture, KindsAreChecked) {
  TextureHandle color, number;
  const vlr_texture_options one = options_with(&vlr_texture_options::channel, 0);
  ASSERT_EQ(VLR_OK, vlr_texture_create(2, 2, 3, kPixels, nullptr, &color.texture));
  ASSERT_EQ(VLR_OK, vlr_texture_create(2, 2, 3, kPixels, &one, &number.texture));
  vlr_scene* scene = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene));
  uint32_t material = 0;
  vlr_principled_textures textures;
  vlr_principled_textures_init(&textures);
  textures.alpha = color.texture;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_scene_add_textured_material(scene, nullptr, &textures, &material));
  EXPECT_NE(std::string(vlr_last_error()).find("alpha"), std::string::npos);
  textures.alpha = number.texture;
  textures.base_color = number.texture;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_scene_add_textured_material(scene, nullptr, &textures, &material));
  textures.base_color = color.texture;
  EXPECT_EQ(VLR_OK, vlr_scene_add_textured_material(scene, nullptr, &textures, &material));
  vlr_scene_free(scene);
}

/// The material keeps its picture when the handle goes.
TEST(Texture, APlaneShowsItsPicture) {
  vlr_scene* scene = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&scene));
  uint32_t mesh = 0, material = 0;
  {
    TextureHandle color;
    const vlr_texture_options closest = options_with(&vlr_texture_options::filter, VLR_FILTER_CLOSEST);
    ASSERT_EQ(VLR_OK, vlr_texture_create(2, 2, 3, kPixels, &closest, &color.texture));
    vlr_principled_desc desc;
    vlr_principled_desc_init(&desc);
    desc.specular = 0;
    vlr_principled_textures textures;
    vlr_principled_textures_init(&textures);
    textures.base_color = color.texture;
    ASSERT_EQ(VLR_OK, vlr_scene_add_textured_material(scene, &desc, &textures, &material));
  }
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, uvs[] = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
  vlr_mesh_desc plane = {};
  plane.struct_size = sizeof plane;
  plane.vertex_count = 4;
  plane.triangle_count = 2;
  plane.positions = positions;
  plane.triangles = triangles;
  plane.corner_uvs = uvs;
  ASSERT_EQ(VLR_OK, vlr_scene_add_mesh(scene, &plane, &mesh, nullptr));
  const float place[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, white[3] = {1, 1, 1};
  ASSERT_EQ(VLR_OK, vlr_scene_add_instance(scene, mesh, place, &material, 1));
  ASSERT_EQ(VLR_OK, vlr_scene_set_world_color(scene, white));
  vlr_camera_desc camera;
  vlr_camera_desc_init(&camera);
  camera.type = VLR_CAMERA_ORTHOGRAPHIC;
  camera.camera_to_world[11] = 5;
  const float window[4] = {-1, 1, -1, 1};
  std::copy(window, window + 4, camera.window);
  ASSERT_EQ(VLR_OK, vlr_scene_set_camera(scene, &camera));
  ASSERT_EQ(VLR_OK, vlr_scene_commit(scene));
  vlr_render_options render;
  vlr_render_options_init(&render);
  render.width = render.height = 2;
  render.spp = 64;
  render.strategy = VLR_STRATEGY_COSINE;
  vlr_job* job = nullptr;
  ASSERT_EQ(VLR_OK, vlr_render_create_job(scene, &render, &job));
  vlr_scene_free(scene);
  int32_t done = 0;
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, &done));
  std::vector<float> film(16);
  ASSERT_EQ(VLR_OK, vlr_job_read_pass(job, "Combined", film.data(), film.size()));
  for (size_t i = 0; i < 4; ++i) {
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(film[4 * i + c], kPixels[3 * i + c], 1e-4f) << i;
  }
  vlr_job_free(job);
}

}  // namespace
