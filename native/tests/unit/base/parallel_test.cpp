#include "base/parallel.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace velour::parallel_test {
namespace {

class Pieces : public testing::TestWithParam<int> {
 protected:
  Progress progress_;
};
INSTANTIATE_TEST_SUITE_P(Threads, Pieces, testing::Values(0, 1, 2, 100));

TEST_P(Pieces, EachIsDoneOnceAlsoWithin) {
  constexpr size_t kOuter = 50, kInner = 30;
  std::vector<std::atomic<int>> done(kOuter * kInner);
  parallel_pieces(kOuter, GetParam(), progress_, [&](size_t i) {
    parallel_pieces(kInner, GetParam(), progress_, [&](size_t k) { ++done[i * kInner + k]; });
  });
  for (const std::atomic<int>& count : done) EXPECT_EQ(count, 1);
}

TEST_P(Pieces, NeverMoreAtOnceThanAsked) {
  std::atomic<int> now{0}, most{0};
  parallel_pieces(8, GetParam(), progress_, [&](size_t) {
    parallel_pieces(8, GetParam(), progress_, [&](size_t) {
      const int running = ++now;
      for (int before = most; before < running && !most.compare_exchange_weak(before, running);) {
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      --now;
    });
  });
  const int wanted = arena_concurrency(GetParam());
  EXPECT_LE(most, wanted > 0 ? wanted : tbb::info::default_concurrency());
}

TEST_P(Pieces, AnErrorWithinComesOut) {
  const auto fail = [](size_t k) {
    if (k == 3) throw Error(Status::bad_data, "no");
  };
  EXPECT_THROW(
      parallel_pieces(5, GetParam(), progress_, [&](size_t) { parallel_pieces(5, GetParam(), progress_, fail); }),
      Error);
}

/// Whether pieces that `within` shares out are left out where a piece of the loop around them fails.
template <class Within>
bool leaves_pieces_out(int threads, const Within& within) {
  constexpr size_t kInner = 300;
  std::atomic<bool> left_out{false};
  const auto work = [&](size_t i) {
    if (i == 5) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      throw Error(Status::bad_data, "no");
    }
    std::atomic<size_t> done{0};
    within(kInner, [&](size_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(20));
      ++done;
    });
    if (done != kInner) left_out = true;
  };
  EXPECT_THROW(parallel_pieces(6, threads, Progress(), work), Error);
  return left_out;
}

TEST_P(Pieces, AnErrorBesideLeavesNoneOut) {
  EXPECT_FALSE(leaves_pieces_out(
      GetParam(), [&](size_t count, const auto& work) { parallel_pieces(count, GetParam(), progress_, work); }));
}

TEST_P(Pieces, AnErrorBesideLeavesNoneOutOfATable) {
  EXPECT_FALSE(leaves_pieces_out(GetParam(), [](size_t count, const auto& work) { parallel_fill(count, work); }));
}

}  // namespace
}  // namespace velour::parallel_test
