#include "render/path/path_numbers.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/simd.h"

namespace velour::point_batch_test {
namespace {

TEST(PointBatch, GivesTheBitsOfSobolPointsOnEveryTarget) {
  struct Run {
    uint64_t key;
    uint32_t first;
    int count;
  };
  const Run runs[] = {{1, 0, 4}, {2, 1000, 1}, {0xdeadbeefcafef00dull, 0xfffffff0u, 9}, {5, 7, 0}, {9, 12345, 33}};
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
    PointBatch batch;
    for (int round = 0; round < 2; ++round) {
      batch.clear();
      for (const Run& run : runs) batch.add(SobolSeeds(run.key), run.first, run.count);
      batch.resolve();
      int at = 0;
      for (const Run& run : runs) {
        std::vector<Vec2> expected(static_cast<size_t>(run.count));
        sobol_points(run.key, run.first, expected);
        const auto found = batch.points(at, run.count);
        EXPECT_EQ(std::vector<Vec2>(found.begin(), found.end()), expected) << target;
        at += run.count;
      }
      EXPECT_EQ(batch.count(), at);
    }
  }
  select_simd_target("auto");
}

TEST(PointBatch, LeavesPointsOfNoSequenceAlone) {
  PointBatch batch;
  batch.add(1)[0] = {0.25f, 0.75f};
  batch.resolve();
  EXPECT_EQ(batch.points(0, 1)[0], Vec2(0.25f, 0.75f));
}

}  // namespace
}  // namespace velour::point_batch_test
