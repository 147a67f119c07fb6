// Jobs across the C boundary: progress, cancel at any moment, rerun, free while running.
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "capi/test_scene.h"

namespace velour::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr uint32_t kForEver = 50'000'000;  // samples a pixel: no machine ends this within a test

vlr_job_state state_of(const vlr_job* job) {
  vlr_job_state state{};
  state.struct_size = sizeof state;
  EXPECT_EQ(VLR_OK, vlr_job_poll(job, &state)) << vlr_last_error();
  return state;
}

struct Calls {
  std::vector<double> fractions;
  int cancel_after = 1 << 30;
};

int32_t record(void* user, double fraction, const char* stage) {
  auto& calls = *static_cast<Calls*>(user);
  EXPECT_NE(stage, nullptr);
  calls.fractions.push_back(fraction);
  return static_cast<int>(calls.fractions.size()) < calls.cancel_after ? 1 : 0;
}

TEST(CJob, EndsAtOneAndNeverFalls) {
  TestScene scene;
  vlr_job* job = scene.render_job(32, 64);
  EXPECT_EQ(state_of(job).state, VLR_JOB_READY);
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  Calls calls;
  int32_t finished = 0;
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, record, &calls, &finished)) << vlr_last_error();
  EXPECT_EQ(finished, 1);
  EXPECT_EQ(calls.fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(calls.fractions.begin(), calls.fractions.end()));
  EXPECT_EQ(state_of(job).state, VLR_JOB_DONE);
  EXPECT_GT(state_of(job).bytes_in_use, 0u);
  vlr_job_free(job);
}

TEST(CJob, CancelAtStartEarlyAndLaterThenRunsAgain) {
  TestScene scene;
  vlr_job* job = scene.render_job(256, kForEver);
  for (const auto delay : {0ms, 1ms, 30ms, 200ms}) {
    ASSERT_EQ(VLR_OK, vlr_job_start(job)) << vlr_last_error();
    std::this_thread::sleep_for(delay);
    EXPECT_EQ(VLR_INVALID_STATE, vlr_job_start(job));
    const auto before = Clock::now();
    ASSERT_EQ(VLR_OK, vlr_job_cancel(job));
    EXPECT_EQ(VLR_CANCELLED, vlr_job_wait(job, -1, nullptr, nullptr, nullptr));
    EXPECT_LT(Clock::now() - before, 500ms) << "0.1 s is promised on an idle machine";
    EXPECT_EQ(state_of(job).state, VLR_JOB_CANCELLED);
    const char* json = nullptr;
    EXPECT_EQ(VLR_CANCELLED, vlr_job_report_json(job, &json));
  }
  vlr_job_free(job);
}

TEST(CJob, ACallbackThatReturnsZeroCancels) {
  TestScene scene;
  vlr_job* job = scene.render_job(64, kForEver);
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  Calls calls;
  calls.cancel_after = 2;
  EXPECT_EQ(VLR_CANCELLED, vlr_job_wait(job, -1, record, &calls, nullptr));
  vlr_job_free(job);
}

TEST(CJob, WaitingEndsInTime) {
  TestScene scene;
  vlr_job* job = scene.render_job(64, kForEver);
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  int32_t finished = 1;
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, 0.02, nullptr, nullptr, &finished));
  EXPECT_EQ(finished, 0);
  EXPECT_LT(state_of(job).fraction, 1.0);
  vlr_job_free(job);  // while running: cancels and waits
}

TEST(CJob, AnyNumberOfSecondsMayBeWaited) {
  TestScene scene;
  vlr_job* job = scene.render_job(64, 64);
  const double infinite = std::numeric_limits<double>::infinity();
  Calls calls;
  for (const double seconds : {1e10, infinite}) {
    for (const vlr_progress_fn progress : {vlr_progress_fn{}, vlr_progress_fn{record}}) {
      ASSERT_EQ(VLR_OK, vlr_job_start(job));
      int32_t finished = 0;
      EXPECT_EQ(VLR_OK, vlr_job_wait(job, seconds, progress, &calls, &finished));
      EXPECT_EQ(finished, 1) << seconds;
      EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr));
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_job_wait(job, nan, nullptr, nullptr, nullptr));
  EXPECT_EQ(VLR_INVALID_ARGUMENT, vlr_job_wait(job, nan, record, &calls, nullptr));
  vlr_job_free(job);
}

TEST(CJob, HandlesMayBeFreedInAnyOrder) {
  vlr_job* job = nullptr;
  {
    TestScene scene;
    job = scene.render_job(32, 16);
  }
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  EXPECT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr)) << vlr_last_error();
  vlr_job_free(job);
}

TEST(CJob, ARenderHasNoModel) {
  TestScene scene;
  vlr_job* job = scene.render_job(16, 8);
  vlr_model* model = nullptr;
  EXPECT_EQ(VLR_INVALID_STATE, vlr_job_result_model(job, &model));
  ASSERT_EQ(VLR_OK, vlr_job_start(job));
  ASSERT_EQ(VLR_OK, vlr_job_wait(job, -1, nullptr, nullptr, nullptr));
  EXPECT_EQ(VLR_INVALID_STATE, vlr_job_result_model(job, &model));
  vlr_job_free(job);
}

}  // namespace
}  // namespace velour::test
