#include "base/job.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <limits>

namespace velour::job_test {
namespace {

using namespace std::chrono_literals;

void work_until_cancelled(Progress& progress) {
  progress.stage("working", 0.0, 1.0);
  for (;;) {
    progress.check();
    std::this_thread::sleep_for(1ms);
  }
}

TEST(Job, RunsToTheEndAndReportsOne) {
  Job job([](Progress& p) {
    p.stage("half", 0.0, 0.5);
    p.update(1.0);
    p.stage("rest", 0.5, 1.0);
  });
  EXPECT_EQ(job.poll().state, Job::State::ready);
  EXPECT_THROW(job.rethrow(), Error);
  job.start();
  EXPECT_TRUE(job.wait_for(-1));
  EXPECT_EQ(job.poll().state, Job::State::done);
  EXPECT_EQ(job.poll().fraction, 1.0);
  EXPECT_STREQ(job.poll().stage, "rest");
  EXPECT_NO_THROW(job.rethrow());
}

TEST(Job, CancelEndsItSoonAndItRunsAgain) {
  Job job(work_until_cancelled);
  for (int run = 0; run < 3; ++run) {
    job.start();
    EXPECT_FALSE(job.wait_for(0.005));
    EXPECT_THROW(job.start(), Error);
    const auto before = std::chrono::steady_clock::now();
    job.cancel();
    EXPECT_TRUE(job.wait_for(-1));
    EXPECT_LT(std::chrono::steady_clock::now() - before, 100ms);
    EXPECT_EQ(job.poll().state, Job::State::cancelled);
    EXPECT_THROW(job.rethrow(), Error);
  }
  EXPECT_EQ(Job::running_count(), 0);
}

TEST(Job, KeepsTheSentenceOfAFailure) {
  Job job([](Progress&) { throw Error(Status::bad_data, "file.binary: too short."); });
  job.start();
  job.wait_for(-1);
  EXPECT_EQ(job.poll().state, Job::State::failed);
  try {
    job.rethrow();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::bad_data);
    EXPECT_STREQ(error.what(), "file.binary: too short.");
  }
}

/// Threads that begin while this lives ask for a stack that no machine has.
class NoThreads {
 public:
  NoThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t huge = before_;
    pthread_attr_setstacksize(&huge, size_t{1} << 60);
    EXPECT_EQ(pthread_setattr_default_np(&huge), 0);
  }
  ~NoThreads() { pthread_setattr_default_np(&before_); }

 private:
  pthread_attr_t before_;
};

TEST(Job, WithoutAThreadItStaysAsItWas) {
  Job job([](Progress&) {});
  for (const Job::State before : {Job::State::ready, Job::State::done}) {
    {
      const NoThreads none;
      EXPECT_THROW(job.start(), Error);
    }
    EXPECT_EQ(job.poll().state, before);
    EXPECT_EQ(Job::running_count(), 0);
    job.start();
    EXPECT_TRUE(job.wait_for(-1));
    EXPECT_NO_THROW(job.rethrow());
  }
}

TEST(Job, NothingIsMadeReadyForAStartThatIsRefused) {
  Job job(work_until_cancelled);
  int calls = 0;
  job.start([&] { ++calls; });
  EXPECT_THROW(job.start([&] { ++calls; }), Error);
  EXPECT_EQ(calls, 1);
  job.cancel();
  job.wait_for(-1);
  EXPECT_THROW(job.start([] { throw Error(Status::invalid_state, "no."); }), Error);
  EXPECT_EQ(job.poll().state, Job::State::cancelled);
}

TEST(Job, WaitsAsLongAsTheClockCannotCount) {
  for (const double seconds : {1e9, 1e10, 1e300, std::numeric_limits<double>::infinity()}) {
    Job job([](Progress&) { std::this_thread::sleep_for(20ms); });
    job.start();
    EXPECT_TRUE(job.wait_for(seconds)) << seconds;
  }
}

TEST(Job, DestructionCancels) {
  {
    Job job(work_until_cancelled);
    job.start();
  }
  EXPECT_EQ(Job::running_count(), 0);
}

TEST(Progress, NeverFalls) {
  Progress p;
  p.stage("a", 0.0, 0.5);
  p.update(0.8);
  const double before = p.fraction();
  p.update(0.2);
  EXPECT_EQ(p.fraction(), before);
  p.stage("b", 0.5, 1.0);
  EXPECT_EQ(p.fraction(), 0.5);
}

}  // namespace
}  // namespace velour::job_test
