// A picture through the C API: its values, its passes, its independence of threads.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "capi/test_scene.h"

namespace velour::test {
namespace {

constexpr uint32_t kSize = 24;

std::vector<float> rendered(const TestScene& scene, const char* pass, uint32_t channels, uint32_t threads) {
  vlr_job* job = scene.render_job(kSize, 256, threads);
  EXPECT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  std::vector<float> pixels(size_t{kSize} * kSize * channels, -1.0f);
  EXPECT_EQ(VLR_OK, vlr_job_read_pass(job, pass, pixels.data(), pixels.size())) << vlr_last_error();
  const char* json = nullptr;
  EXPECT_EQ(VLR_OK, vlr_job_report_json(job, &json)) << vlr_last_error();
  EXPECT_NE(std::strstr(json, "\"samples_per_second\""), nullptr) << json;
  vlr_job_free(job);
  return pixels;
}

TEST(CScene, AWhiteSquareUnderAGrayWorldReflectsItsAlbedo) {
  // Radiance = albedo x world = 0.8 x 0.5: cosine sampling of a Lambertian surface has no variance.
  const auto pixels = rendered(TestScene(), "Combined", 4, 2);
  for (size_t i = 0; i < pixels.size(); i += 4) {
    EXPECT_NEAR(pixels[i], 0.4f, 0.004f);
    EXPECT_NEAR(pixels[i + 3], 1.0f, 1e-6f);
  }
}

TEST(CScene, PassesHoldDepthNormalAndCounts) {
  const TestScene scene;
  const auto depth = rendered(scene, "Depth", 1, 1);
  const auto normal = rendered(scene, "Normal", 3, 1);
  const auto count = rendered(scene, "Sample Count", 1, 1);
  EXPECT_NEAR(depth[depth.size() / 2 + kSize / 2], 2.0f, 0.01f);
  EXPECT_NEAR(normal[2], 1.0f, 1e-5f);
  for (const float c : count) EXPECT_EQ(c, 256.0f);
}

TEST(CScene, ThreadsDoNotChangeABit) {
  const TestScene scene;
  const auto one = rendered(scene, "Combined", 4, 1), three = rendered(scene, "Combined", 4, 3);
  EXPECT_EQ(0, std::memcmp(one.data(), three.data(), one.size() * sizeof(float)));
}

TEST(CScene, AWorldsImageIsPlacedAnewAndAColorIsNot) {
  const TestScene scene;
  vlr_scene* world = scene.scene;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_scene_place_world(world, 1, nullptr));
  const std::vector<float> gray(8, 0.25f);
  ASSERT_EQ(VLR_OK, vlr_scene_set_world_pixels(world, 4, 2, 1, gray.data(), 1, nullptr)) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_scene_place_world(world, 2, nullptr)) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_scene_commit(world)) << vlr_last_error();
  const auto pixels = rendered(scene, "Combined", 4, 2);
  EXPECT_NEAR(pixels[0], 0.4f, 0.004f);
  const float stretch[9] = {2, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(VLR_BAD_DATA, vlr_scene_place_world(world, 2, stretch));
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_scene_place_world(nullptr, 2, nullptr));
}

TEST(CScene, WrongReadsAndScenesAreRefused) {
  const TestScene scene;
  vlr_job* job = scene.render_job(8, 8);
  float pixel[4];
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_job_read_pass(job, "Combined", pixel, 4));
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_job_read_pass(job, "Beauty", pixel, 4));
  vlr_job_free(job);

  vlr_scene* bare = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&bare));
  vlr_render_options options;
  vlr_render_options_init(&options);
  job = nullptr;
  EXPECT_EQ(VLR_INVALID_STATE, vlr_render_create_job(bare, &options, &job)) << "not committed";
  const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const uint32_t material = 7;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_scene_add_instance(bare, 3, identity, &material, 1));
  vlr_scene_free(bare);
}

TEST(CScene, ZeroSizedFilmsAreRefused) {
  const TestScene scene;
  vlr_render_options options;
  vlr_render_options_init(&options);
  options.width = 0;
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_render_create_job(scene.scene, &options, &job));
  options.width = 16;
  options.strategy = 99;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_render_create_job(scene.scene, &options, &job));
}

/// Where Open Image Denoise is installed, the picture too (VELOUR_OIDN, as scripts/test sets it).
TEST(CScene, PicturesAreDenoisedWhoseRenderWasToldSo) {
  const TestScene scene;
  vlr_job *render = scene.render_job(8, 8), *denoise = nullptr;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_denoise_create_job(render, 1, &denoise));
  vlr_job_free(render);
  vlr_render_options options;
  vlr_render_options_init(&options);
  options.width = options.height = 16;
  options.denoise = 1;
  ASSERT_EQ(VLR_OK, vlr_render_create_job(scene.scene, &options, &render));
  ASSERT_EQ(VLR_OK, vlr_job_start(render));
  ASSERT_EQ(VLR_OK, vlr_job_wait(render, -1, nullptr, nullptr, nullptr));
  std::vector<float> pixels(4 * 16 * 16);
  EXPECT_EQ(VLR_INVALID_STATE, vlr_job_read_pass(render, "Denoised", pixels.data(), pixels.size()));
  if (const char* file = std::getenv("VELOUR_OIDN")) {
    EXPECT_EQ(VLR_OK, vlr_set_denoiser_file(file));
  }
  const char* json = nullptr;
  if (vlr_denoiser_json(&json) == VLR_OK) {
    ASSERT_EQ(VLR_OK, vlr_denoise_create_job(render, 1, &denoise));
    ASSERT_EQ(VLR_OK, vlr_job_start(denoise));
    ASSERT_EQ(VLR_OK, vlr_job_wait(denoise, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
    EXPECT_EQ(VLR_OK, vlr_job_read_pass(render, "Denoised", pixels.data(), pixels.size()));
    EXPECT_NEAR(pixels[4 * 100], 0.4f, 0.03f);  // the albedo of 0.8 under a world of 0.5
    ASSERT_EQ(VLR_OK, vlr_job_report_json(denoise, &json));
    EXPECT_NE(std::string(json).find("relmse_bound"), std::string::npos);
    vlr_job_free(denoise);
  } else {
    EXPECT_NE(std::string(vlr_last_error()).find("libOpenImageDenoise"), std::string::npos);
  }
  vlr_job_free(render);
}

TEST(CScene, SamplingOptionsOutOfRangeFailWithASentence) {
  const TestScene scene;
  for (int wrong = 0; wrong < 4; ++wrong) {
    vlr_render_options options;
    vlr_render_options_init(&options);
    options.width = options.height = 4;
    if (wrong == 0) options.share = 1.5;
    if (wrong == 1) options.noise = -1;
    if (wrong == 2) options.heuristic = 7;
    if (wrong == 3) options.sequence = -1;
    vlr_job* job = nullptr;
    ASSERT_EQ(VLR_OK, vlr_render_create_job(scene.scene, &options, &job));
    ASSERT_EQ(VLR_OK, vlr_job_start(job));
    EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << wrong;
    EXPECT_NE(std::string(vlr_last_error()), "");
    vlr_job_free(job);
  }
}

}  // namespace
}  // namespace velour::test
