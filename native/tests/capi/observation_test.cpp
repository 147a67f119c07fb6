// Observations through the C API.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "capi/test_scene.h"
#include "support/test_data.h"

namespace velour::test {
namespace {

vlr_observe_options small_picture(uint32_t threads = 2) {
  vlr_observe_options options;
  vlr_observe_options_init(&options);
  options.width = options.height = 16;
  options.threads = threads;
  return options;
}

vlr_observation* observed(const TestScene& scene, uint32_t threads = 2) {
  const auto options = small_picture(threads);
  vlr_job* job = nullptr;
  EXPECT_EQ(VLR_OK, vlr_observe_create_job(scene.scene, 0, &options, &job)) << vlr_last_error();
  EXPECT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  vlr_observation* observation = nullptr;
  EXPECT_EQ(VLR_OK, vlr_job_result_observation(job, &observation)) << vlr_last_error();
  vlr_job_free(job);
  return observation;
}

std::string info_of(vlr_observation* observation) {
  const char* json = nullptr;
  EXPECT_EQ(VLR_OK, vlr_observation_info_json(observation, &json)) << vlr_last_error();
  return json;
}

bool says(const std::string& json, const std::string& part) { return json.find(part) != std::string::npos; }

TEST(CObservation, TellsWhatASquareSeenFromAboveIsAskedFor) {
  vlr_observation* observation = observed(TestScene());
  const std::string info = info_of(observation);
  EXPECT_TRUE(says(info, "\"kind\":\"observation\"") && says(info, "\"frames\":1")) << info;
  EXPECT_TRUE(says(info, "\"hits\":1024") && says(info, "\"share\":1.0")) << info;
  EXPECT_TRUE(says(info, "\"views\":[0,")) << info;
  vlr_observation_free(observation);
}

TEST(CObservation, ThreadsDoNotChangeABit) {
  const TestScene scene;
  vlr_observation *one = observed(scene, 1), *three = observed(scene, 3);
  EXPECT_EQ(info_of(one), info_of(three));
  vlr_observation_free(one);
  vlr_observation_free(three);
}

TEST(CObservation, GrowsByMergingAndSurvivesItsFile) {
  vlr_observation *frame = observed(TestScene()), *all = nullptr, *read = nullptr;
  ASSERT_EQ(VLR_OK, vlr_observation_create(&all));
  EXPECT_TRUE(says(info_of(all), "\"views\":null"));
  ASSERT_EQ(VLR_OK, vlr_observation_merge(all, frame));
  EXPECT_EQ(info_of(all), info_of(frame));
  ASSERT_EQ(VLR_OK, vlr_observation_merge(all, all));
  EXPECT_TRUE(says(info_of(all), "\"frames\":2"));
  const std::string path = scratch_folder() / "scene.json";
  ASSERT_EQ(VLR_OK, vlr_observation_save(all, path.c_str())) << vlr_last_error();
  ASSERT_EQ(VLR_OK, vlr_observation_load(path.c_str(), &read)) << vlr_last_error();
  EXPECT_EQ(info_of(read), info_of(all));
  const char* json = nullptr;
  ASSERT_EQ(VLR_OK, vlr_file_info_json(path.c_str(), &json)) << vlr_last_error();
  EXPECT_EQ(json, info_of(all));
  for (vlr_observation* o : {frame, all, read}) vlr_observation_free(o);
}

TEST(CObservation, WrongRequestsAreRefused) {
  const TestScene scene;
  vlr_job* job = nullptr;
  auto options = small_picture();
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_observe_create_job(scene.scene, 1, &options, &job));
  EXPECT_NE(std::string(vlr_last_error()).find("Material 1"), std::string::npos);
  options.width = 0;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_observe_create_job(scene.scene, 0, &options, &job));
  options.width = 0xffffffffu;
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_observe_create_job(scene.scene, 0, &options, &job));
  options = small_picture();
  options.struct_size += 8;
  EXPECT_EQ(VLR_VERSION_MISMATCH, vlr_observe_create_job(scene.scene, 0, &options, &job));
  vlr_scene* bare = nullptr;
  ASSERT_EQ(VLR_OK, vlr_scene_create(&bare));
  EXPECT_EQ(VLR_INVALID_STATE, vlr_observe_create_job(bare, 0, nullptr, &job)) << "not committed";
  vlr_scene_free(bare);
  EXPECT_EQ(job, nullptr);
}

TEST(CObservation, OtherJobsMakeNone) {
  const TestScene scene;
  vlr_job* job = scene.render_job(8, 8);
  vlr_observation* observation = nullptr;
  EXPECT_EQ(VLR_INVALID_STATE, vlr_job_result_observation(job, &observation)) << "not run";
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr));
  EXPECT_EQ(VLR_INVALID_STATE, vlr_job_result_observation(job, &observation));
  EXPECT_EQ(observation, nullptr);
  vlr_job_free(job);
}

TEST(CObservation, CancelsAndRunsAgain) {
  const TestScene scene;
  vlr_job* job = nullptr;
  const auto options = small_picture();
  ASSERT_EQ(VLR_OK, vlr_observe_create_job(scene.scene, 0, &options, &job));
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_cancel(job));
  const vlr_status status = vlr_job_wait(job, -1, nullptr, nullptr, nullptr);
  EXPECT_TRUE(status == VLR_CANCELLED || status == VLR_OK) << status;
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  vlr_job_free(job);
}

}  // namespace
}  // namespace velour::test
