#include "votf/eval/shell_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/example_shell.h"

namespace velour::shell_depth_test {
namespace {

/// Signed distance from the nearest wire's axis to the line along `w` through x = `place` of the plane z = 0.
float from_axis(float place, const Vec3& w) {
  const float cosine = w.z / std::hypot(w.x, w.z);
  return (place - 0.5f) * cosine;
}

TEST(ShellDepth, OfALineThroughAWireIsItsRadiusLessHowFarItPassesTheAxis) {
  constexpr float kRadius = 0.1f;
  const ShellField field(test::wires(64, kRadius));
  const float pitch = field.volume().pitch();
  int through = 0, beside = 0;
  for (int i = 0; i < 2000; ++i) {
    RandomStream numbers(3, static_cast<uint64_t>(i), 0);
    const float place = 0.5f + 0.3f * (numbers.next() - 0.5f);
    const Vec3 w = direction(radians_from(40.0f) * numbers.next(), numbers.next() < 0.5f ? 0.0f : kPi);
    const ShellWay way = line_through(field.volume(), {place, numbers.next()}, w);
    const float passes = from_axis(place, w), expected = kRadius - std::abs(passes);
    const ShellDepth deepest = deepest_behind(field, way, way.begin, 1);
    // Places are a pitch apart, so one lies within half a pitch of the deepest. Look-ups between the grid's points
    // round off the ridge of distances that the axis is.
    const float off = std::hypot(std::abs(passes), 0.5f * pitch) - std::abs(passes);
    EXPECT_NEAR(deepest.depth, expected, off + (std::abs(passes) < pitch ? 0.5f : 0.1f) * pitch) << passes;
    const Vec3 at = way.ray.at(deepest.s) + Vec3(0, 0, field.volume().top);
    EXPECT_LT(std::abs(std::hypot(at.x - 0.5f, at.z) - std::abs(passes)), pitch);
    through += expected > 0 ? 1 : 0;
    beside += expected < 0 ? 1 : 0;
  }
  EXPECT_GT(through, 500);
  EXPECT_GT(beside, 200);
}

TEST(ShellDepth, EndsWhereItIsMoreThanAskedFor) {
  const ShellField field(test::wires(64, 0.1f));
  const float pitch = field.volume().pitch();
  const ShellWay way = line_through(field.volume(), {0.5f, 0.5f}, {0, 0, 1});
  EXPECT_GE(deepest_behind(field, way, way.begin, pitch).depth, pitch);
  EXPECT_GT(deepest_behind(field, way, way.begin, 1).depth, 5 * pitch);
}

TEST(ShellDepth, EndsOnAWayThatIsOver) {
  const ShellField field(test::wires(64, 0.1f));
  ShellWay way = line_through(field.volume(), {0.5f, 0.5f}, {0, 0, 1});
  const ShellDepth usual = deepest_behind(field, way, way.end, 1);
  way.speed = std::numeric_limits<float>::infinity();
  EXPECT_EQ(deepest_behind(field, way, way.end, 1).depth, usual.depth);
}

TEST(ShellDepth, BackwardsItIsTheSame) {
  const ShellField field(test::wires(64, 0.1f));
  for (const float place : {0.42f, 0.5f, 0.57f}) {
    ShellWay way = line_through(field.volume(), {place, 0.5f}, direction(0.4f, 0));
    const ShellDepth onwards = deepest_behind(field, way, way.begin, 1);
    std::swap(way.begin, way.end);
    const ShellDepth back = deepest_behind(field, way, way.begin, 1);
    EXPECT_NEAR(onwards.depth, back.depth, 0.2f * field.volume().pitch());
    EXPECT_NEAR(onwards.s, back.s, 1.01f * field.volume().pitch());
  }
}

TEST(ShellOutline, LiesToTheSideThatIsNearer) {
  constexpr float kRadius = 0.1f;
  const ShellField field(test::wires(64, kRadius));
  const float pitch = field.volume().pitch(), most = 3 * pitch;
  for (const float place : {0.42f, 0.425f, 0.575f, 0.58f}) {
    for (const float theta : {0.0f, 0.3f}) {
      const Vec3 w = direction(theta, kPi / 2);  // along the wire: what lies across is the same
      const ShellWay way = line_through(field.volume(), {place, 0.5f}, w);
      const ShellHit hit = trace_shell(field, way);
      ASSERT_TRUE(hit);
      const ShellOutline outline = outline_beside(field, way, hit.s, most);
      EXPECT_NEAR(outline.depth, kRadius - std::abs(place - 0.5f), 0.2f * pitch);
      EXPECT_GT(outline.outside.x * (place < 0.5f ? -1 : 1), 0.98f) << place << ' ' << theta;
    }
  }
  const ShellWay middle = line_through(field.volume(), {0.5f, 0.5f}, {0, 0, 1});
  EXPECT_EQ(outline_beside(field, middle, trace_shell(field, middle).s, most).outside, Vec3(0.0f));
}

}  // namespace
}  // namespace velour::shell_depth_test
