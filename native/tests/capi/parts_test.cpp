// Parts of pictures across the C boundary: crops, ranges, a stop, and the files that say what they are.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "capi/test_scene.h"
#include "support/test_data.h"

namespace velour::test {
namespace {

vlr_render_options small_render() {
  vlr_render_options options;
  vlr_render_options_init(&options);
  options.width = options.height = 8;
  options.spp = 16;
  return options;
}

/// "Combined" of a finished render, `count` floats.
std::vector<float> rendered(const TestScene& scene, const vlr_render_options& options, size_t count) {
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_OK, vlr_render_create_job(scene.scene, &options, &job)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  std::vector<float> pixels(count);
  EXPECT_EQ(VLR_OK, vlr_job_read_pass(job, "Combined", pixels.data(), count)) << vlr_last_error();
  vlr_job_free(job);
  return pixels;
}

TEST(CParts, ACropHoldsItsOwnPixels) {
  const TestScene scene;
  vlr_render_options options = small_render();
  const std::vector<float> whole = rendered(scene, options, 8 * 8 * 4);
  options.crop_x0 = 2;
  options.crop_y0 = 5;
  options.crop_x1 = 6;
  options.crop_y1 = 7;
  const std::vector<float> crop = rendered(scene, options, 4 * 2 * 4);
  for (size_t y = 0; y < 2; ++y) {
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(crop[16 * y + i], whole[4 * (8 * (5 + y) + 2) + i]);
  }
  options.crop_x1 = 9;
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_render_create_job(scene.scene, &options, &job));
  EXPECT_NE(std::string(vlr_last_error()).find("crop"), std::string::npos);
}

TEST(CParts, RangesReachTheRender) {
  const TestScene scene;
  vlr_render_options options = small_render();
  const std::vector<float> whole = rendered(scene, options, 8 * 8 * 4);
  options.samples_end = 8;
  const std::vector<float> first = rendered(scene, options, 8 * 8 * 4);
  options.samples_begin = 8;
  options.samples_end = 0;
  const std::vector<float> second = rendered(scene, options, 8 * 8 * 4);
  for (size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR((first[i] + second[i]) / 2, whole[i], 1e-6f);
  EXPECT_NE(first, second);
}

TEST(CParts, AStoppedRenderIsDoneAndStartsAnewInFull) {
  const TestScene scene;
  vlr_job* job = scene.render_job(64, 1 << 24);
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ASSERT_EQ(VLR_OK, vlr_job_stop(job));
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  const char* report = nullptr;
  EXPECT_EQ(VLR_OK, vlr_job_report_json(job, &report));
  vlr_job_free(job);

  job = scene.render_job(8, 64);
  ASSERT_EQ(VLR_OK, vlr_job_stop(job));  // before it starts: no longer known when it does
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  std::vector<float> counts(64);
  ASSERT_EQ(VLR_OK, vlr_job_read_pass(job, "Sample Count", counts.data(), counts.size()));
  for (float count : counts) EXPECT_EQ(count, 64);
  vlr_job_free(job);
}

TEST(CParts, AStartThatIsRefusedForgetsNoStop) {
  const TestScene scene;
  vlr_job* job = scene.render_job(64, 1 << 24);
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_stop(job));
  const bool refused = vlr_job_start(job) == VLR_INVALID_STATE;
  if (!refused) {
    ASSERT_EQ(VLR_OK, vlr_job_stop(job));  // it was done already
  }
  int32_t finished = 0;
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, 60, nullptr, nullptr, &finished)) << vlr_last_error();
  EXPECT_EQ(finished, 1);
  vlr_job_free(job);
}

std::vector<float> sums_of(const vlr_job* job) {
  uint32_t per_pixel = 0;
  EXPECT_EQ(VLR_OK, vlr_job_read_sums(job, nullptr, 0, &per_pixel));
  std::vector<float> sums(size_t{64} * per_pixel);
  EXPECT_EQ(VLR_OK, vlr_job_read_sums(job, sums.data(), sums.size(), nullptr)) << vlr_last_error();
  return sums;
}

TEST(CParts, WhatWasAddedIsNeverCountedTwice) {
  const TestScene scene;
  vlr_job* other = scene.render_job(8, 16);
  ASSERT_EQ(VLR_OK, vlr_job_start(other));
  ASSERT_EQ(VLR_OK, vlr_job_wait(other, -1, nullptr, nullptr, nullptr));
  const std::vector<float> sums = sums_of(other);
  vlr_job_free(other);
  for (const bool before : {true, false}) {
    vlr_job* job = scene.render_job(8, 64);
    const auto add = [&] { ASSERT_EQ(VLR_OK, vlr_job_add_sums(job, sums.data(), sums.size())) << vlr_last_error(); };
    if (before) add();
    ASSERT_EQ(VLR_OK, vlr_job_start(job)) << vlr_last_error();
    ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
    if (!before) add();
    EXPECT_EQ(VLR_INVALID_STATE, vlr_job_start(job));
    EXPECT_NE(std::string(vlr_last_error()).find("Create a new job"), std::string::npos) << vlr_last_error();
    std::vector<float> counts(64);
    ASSERT_EQ(VLR_OK, vlr_job_read_pass(job, "Sample Count", counts.data(), counts.size()));
    for (float count : counts) EXPECT_EQ(count, 80);
    vlr_job_free(job);
  }
}

TEST(CParts, FilesSayWhereTheyLie) {
  const std::string path = scratch_folder() / "part.exr";
  const std::vector<float> pixels(2 * 3 * 4, 0.5f);
  vlr_image_frame frame{sizeof(vlr_image_frame), 10, 8, 1, 2};
  const char* texts[] = {"velour.samples", "0:8", "velour.render", "{}"};
  ASSERT_EQ(VLR_OK, vlr_image_write_part(path.c_str(), 2, 3, 4, pixels.data(), &frame, texts, 2)) << vlr_last_error();
  const char* json = nullptr;
  ASSERT_EQ(VLR_OK, vlr_image_header_json(path.c_str(), &json)) << vlr_last_error();
  EXPECT_EQ(std::string(json),
            R"({"width":2,"height":3,"channels":["R","G","B","A"],"frame":{"width":10,"height":8,"x":1,"y":2},)"
            R"("multi_part":false,"texts":{"velour.render":"{}","velour.samples":"0:8"}})");
  ASSERT_EQ(VLR_OK, vlr_image_write_part(path.c_str(), 2, 3, 4, pixels.data(), nullptr, nullptr, 0));
  ASSERT_EQ(VLR_OK, vlr_image_header_json(path.c_str(), &json)) << vlr_last_error();
  EXPECT_NE(std::string(json).find(R"("frame":{"width":2,"height":3,"x":0,"y":0},"multi_part":false,"texts":{})"),
            std::string::npos);

  const std::vector<float> all_passes(2 * 3 * 159, 0.5f);
  EXPECT_EQ(VLR_OK, vlr_image_write_part(path.c_str(), 2, 3, 159, all_passes.data(), nullptr, nullptr, 0));

  frame.x = 9;  // beyond the right edge
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_image_write_part(path.c_str(), 2, 3, 4, pixels.data(), &frame, nullptr, 0));
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_image_write_part(path.c_str(), 2, 3, 4, pixels.data(), nullptr, nullptr, 1));
}

}  // namespace
}  // namespace velour::test
