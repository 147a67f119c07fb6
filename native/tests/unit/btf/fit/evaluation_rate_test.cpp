#include "btf/fit/btf_fit.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace velour::evaluation_rate_test {
namespace {

using namespace std::chrono_literals;

std::vector<BtfQuery> some() {
  std::vector<BtfQuery> queries = random_queries();
  queries.resize(5);
  return queries;
}

/// A thread that does not run, as on a machine that others use, costs nothing.
TEST(EvaluationRate, CountsProcessorTimeAlone) {
  const double asleep = seconds_a_query(some(), [](const BtfQuery& query) {
    std::this_thread::sleep_for(3ms);
    return query.place.x;
  });
  EXPECT_LT(asleep, 1e-3);
  // The control: work of as long is counted.
  const double busy = seconds_a_query(some(), [](const BtfQuery& query) {
    const double start = thread_seconds();
    while (thread_seconds() - start < 3e-3) continue;
    return query.place.x;
  });
  EXPECT_GE(busy, 3e-3);
}

TEST(EvaluationRate, IsOverOneQuerysSeconds) {
  const double rate = evaluation_rate([](const BtfQuery&) {
    const double start = thread_seconds();
    while (thread_seconds() - start < 2e-6) continue;
    return Rgb(0.0f);
  });
  EXPECT_LE(rate, 5e5);
  EXPECT_GT(rate, 1e5);
}

TEST(EvaluationRate, AsksForPlacesOfTheTileAndDirectionsAbove) {
  for (const BtfQuery& query : random_queries()) {
    ASSERT_TRUE(query.place.x >= 0 && query.place.x < 1 && query.place.y >= 0 && query.place.y < 1);
    ASSERT_TRUE(query.pair.wv.z >= 0 && query.pair.wl.z >= 0);
  }
}

}  // namespace
}  // namespace velour::evaluation_rate_test
