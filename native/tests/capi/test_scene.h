// A small scene through the C API: a white square of 2 m under a gray world, seen from above.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "velour/velour.h"

namespace velour::test {

class TestScene {
 public:
  TestScene() {
    EXPECT_EQ(VLR_OK, vlr_scene_create(&scene)) << vlr_last_error();
    add_square();
    const float world[3] = {0.5f, 0.5f, 0.5f};
    EXPECT_EQ(VLR_OK, vlr_scene_set_world_color(scene, world));
    const float eye[3] = {0, 0, 2}, target[3] = {0, 0.001f, 0};
    EXPECT_EQ(VLR_OK, vlr_scene_look_at(scene, eye, target, 0.5f, 1.0f));
    EXPECT_EQ(VLR_OK, vlr_scene_commit(scene)) << vlr_last_error();
  }
  ~TestScene() { vlr_scene_free(scene); }
  TestScene(const TestScene&) = delete;
  TestScene& operator=(const TestScene&) = delete;

  /// A job of `size` x `size` pixels; the caller frees it.
  vlr_job* render_job(uint32_t size, uint32_t spp, uint32_t threads = 1) const {
    vlr_render_options options;
    vlr_render_options_init(&options);
    options.width = options.height = size;
    options.spp = spp;
    options.strategy = VLR_STRATEGY_COSINE;
    options.threads = threads;
    vlr_job* job = nullptr;
    EXPECT_EQ(VLR_OK, vlr_render_create_job(scene, &options, &job)) << vlr_last_error();
    return job;
  }

  vlr_scene* scene = nullptr;

 private:
  void add_square() {
    const float positions[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    vlr_mesh_desc mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = 4;
    mesh.triangle_count = 2;
    mesh.positions = positions;
    mesh.triangles = triangles;
    uint32_t mesh_id = 0, dropped = 0, material = 0;
    EXPECT_EQ(VLR_OK, vlr_scene_add_mesh(scene, &mesh, &mesh_id, &dropped)) << vlr_last_error();
    vlr_principled_desc white;
    vlr_principled_desc_init(&white);
    white.specular = 0;
    white.base_color[0] = white.base_color[1] = white.base_color[2] = 0.8f;
    EXPECT_EQ(VLR_OK, vlr_scene_add_principled_material(scene, &white, &material)) << vlr_last_error();
    const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    EXPECT_EQ(VLR_OK, vlr_scene_add_instance(scene, mesh_id, identity, &material, 1)) << vlr_last_error();
  }
};

}  // namespace velour::test
