#include "votf/eval/shell_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/example_shell.h"

namespace velour::shell_trace_test {
namespace {

/// Where a straight ray is over a circle of `radius` (0: a line), from the top of it down at `cosine`: how far along
/// the circle, and how high over it.
Vec2 over_circle(float radius, float cosine, float s) {
  const double sine = std::sqrt(1.0 - double{cosine} * double{cosine});
  if (radius == 0) return {sine * double{s}, -double{cosine} * double{s}};
  const double x = sine * double{s}, y = double{radius} - double{cosine} * double{s};
  const double sign = radius < 0 ? -1 : 1;
  return {double{radius} * std::atan2(sign * x, sign * y), sign * std::hypot(x, y) - double{radius}};
}

TEST(ShellRay, IsAStraightRayOverACircle) {
  for (const float radius : {0.0f, 1.0f, 5.0f, -1.0f, -5.0f}) {
    for (const float cosine : {1.0f, 0.9f, 0.5f, 0.2f, 0.01f}) {
      const ShellRay ray{{0.25f, 0.5f}, {0, 2}, cosine, radius == 0 ? 0 : 1 / radius, 3};
      for (const float s : {-0.1f, 0.0f, 0.05f, 0.3f, 0.7f, 1.5f, 4.0f}) {
        if (radius > 0 && radius - cosine * s < 0.2f * s) continue;  // beyond 79 degrees or so
        const Vec2 expected = over_circle(radius, cosine, s);
        const Vec3 found = ray.at(s);
        EXPECT_NEAR(found.x, 0.25f, 1e-6f);
        EXPECT_NEAR(found.y, 0.5f + 2 * expected.x, 2e-5f * (1 + std::abs(expected.x)))
            << radius << ' ' << cosine << ' ' << s;
        EXPECT_NEAR(found.z, 3 * expected.y, 1e-5f) << radius << ' ' << cosine << ' ' << s;
      }
    }
  }
}

TEST(ShellRay, EndsAtTheBottomOrAtTheTop) {
  VotfVolume volume;
  volume.bottom = -0.1f;
  volume.top = 0.1f;
  for (const float curvature : {0.0f, 0.2f, 1.0f, -0.5f}) {
    for (const float cosine : {1.0f, 0.7f, 0.5f, 0.3f, 0.05f}) {
      const ShellRay ray{{0, 0}, {1, 0}, cosine, curvature, 1};
      const ShellSpan span = span_of(ray, volume);
      EXPECT_GT(span.end, 0);
      EXPECT_NEAR(ray.at(span.end).z, span.through_bottom ? -0.2f : 0.0f, 1e-4f) << curvature << ' ' << cosine;
      if (!span.through_bottom) {
        EXPECT_GT(ray.at(span.end / 2).z, -0.2f);
      }
    }
  }
  EXPECT_FALSE(span_of({{0, 0}, {1, 0}, 0.3f, 1.0f, 1}, volume).through_bottom);
  EXPECT_TRUE(span_of({{0, 0}, {1, 0}, 0.3f, 0.1f, 1}, volume).through_bottom);
}

TEST(ShellRay, FromASideItGoesToTheBottomOrTheTop) {
  VotfVolume volume;
  volume.bottom = -0.1f;
  volume.top = 0.1f;
  int through_bottom = 0, within = 0, all = 0;
  for (const float curvature : {0.0f, 0.3f, 1.0f, -0.3f, -1.0f}) {
    for (const float cosine : {1.0f, 0.3f, 0.05f, 0.0f, -0.05f, -0.3f, -1.0f}) {
      for (const float height : {-0.02f, -0.1f, -0.19f}) {
        const ShellRay ray{{0, 0}, {1, 0}, cosine, curvature, 1, height};
        EXPECT_NEAR(ray.at(0).z, height, 1e-7f);
        for (const bool onwards : {false, true}) {
          const ShellSpan span = span_from_side(ray, volume, onwards);
          const float end = std::min(span.end, 1.0f), sign = onwards ? 1.0f : -1.0f;
          const float radius = curvature == 0 ? 0 : 1 / curvature;
          // Heights are over the circle through the crossing; the last part before the end stays out of rounding.
          for (int i = 1; i < 50; ++i) {
            const float s = 0.998f * sign * end * static_cast<float>(i) / 49, z = ray.at(s).z;
            EXPECT_GT(z, -0.2f - 1e-4f) << curvature << ' ' << cosine << ' ' << height << ' ' << s;
            EXPECT_LT(z, 1e-4f) << curvature << ' ' << cosine << ' ' << height << ' ' << s;
            EXPECT_NEAR(z, height + over_circle(radius, cosine, s).y, 1e-4f);
          }
          ++all;
          within += span.end > 1 ? 1 : 0;
          if (span.end > 1) continue;
          EXPECT_NEAR(ray.at(sign * span.end).z, span.through_bottom ? -0.2f : 0.0f, 1e-4f);
          through_bottom += span.through_bottom ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(through_bottom, all / 4);
  EXPECT_LT(through_bottom, 3 * all / 4);
  EXPECT_LT(within, all / 3);
}

/// A line through x = `place` of the plane z = 0 passes the wires' axes at |x - axis| cos.
bool meets_wires(const Vec2& place, const Vec3& w, float radius) {
  const float cosine = w.z / std::hypot(w.x, w.z);
  float nearest = 1;
  for (int i = -30; i <= 30; ++i) nearest = std::min(nearest, std::abs(place.x - (0.5f + static_cast<float>(i))));
  return nearest * cosine < radius;
}

TEST(LineMeets, KnowsASlabOfParallelWires) {
  constexpr float kRadius = 0.15f;
  const ShellField field(test::wires(64, kRadius));
  int wrong = 0, wrong_of_thicker = 0;
  constexpr int kLines = 20000;
  for (int i = 0; i < kLines; ++i) {
    RandomStream numbers(7, static_cast<uint64_t>(i), 0);
    const Vec2 place = numbers.next2();
    const Vec3 w = direction(radians_from(80.0f) * numbers.next(), 2 * kPi * numbers.next());
    const bool met = line_meets(field, place, w);
    EXPECT_EQ(met, line_meets(field, place + Vec2(3, -2), w)) << "periodic";
    EXPECT_EQ(met, line_meets(field, place, -w)) << "the same line from below";
    wrong += met != meets_wires(place, w, kRadius) ? 1 : 0;
    wrong_of_thicker += met != meets_wires(place, w, 1.1f * kRadius) ? 1 : 0;
  }
  // A wire's outline lies within a twentieth of a texel.
  EXPECT_LT(wrong, kLines * 0.003);
  EXPECT_GT(wrong_of_thicker, kLines * 0.01) << "a tenth of the radius would be noticed";
}

TEST(LineMeets, NothingInAnEmptyShellAndAllOfAFullOne) {
  const ShellField empty(test::shell_of(8, 0, 0.5f, [](const Vec3&) { return 1.0f; }));
  const ShellField full(test::shell_of(8, 0, 0.5f, [](const Vec3& p) { return p.z - 0.2f; }));
  for (const float theta : {0.0f, 30.0f, 75.0f, 89.9f}) {
    const Vec3 w = direction(radians_from(theta), 1.0f);
    EXPECT_FALSE(line_meets(empty, {0.3f, 0.4f}, w)) << theta;
    EXPECT_TRUE(line_meets(full, {0.3f, 0.4f}, w)) << theta;
  }
}

TEST(TraceShell, LeavesThroughTheTopOfABentShellOverWhatItWouldMeetOnAFlatOne) {
  // A floor at half the height.
  const ShellField field(test::shell_of(32, 0, 0.5f, [](const Vec3& p) { return p.z - 0.25f; }));
  const auto meets = [&](float cosine, float curvature) {
    const ShellRay ray{{0, 0}, {1, 0}, cosine, curvature, 1};
    return trace_shell(field, {ray, field.volume(), 0, span_of(ray, field.volume()).end});
  };
  // Down to cosine^2 / (2 curvature), about.
  EXPECT_TRUE(meets(0.3f, 0.0f));
  EXPECT_TRUE(meets(0.3f, 0.12f));
  EXPECT_FALSE(meets(0.3f, 0.25f));
  const auto hit = meets(0.8f, 0.0f);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.place.z, 0.25f, 1e-2f);
  EXPECT_NEAR(hit.s, 0.25f / 0.8f, 1e-2f);
}

TEST(TraceShell, FromTheBottomUpFindsTheOtherSide) {
  const ShellField field(test::wires(64, 0.2f));
  const ShellRay ray{{0.5f, 0.5f}, {1, 0}, 1.0f, 0.0f, 1};
  const float end = span_of(ray, field.volume()).end;
  const ShellHit above = trace_shell(field, {ray, field.volume(), 0, end}),
                 below = trace_shell(field, {ray, field.volume(), end, 0});
  ASSERT_TRUE(above && below);
  EXPECT_NEAR(above.place.z, 0.2f, 5e-3f);
  EXPECT_NEAR(below.place.z, -0.2f, 5e-3f);
}

TEST(TraceShells, DoesWithEachRayWhatItDoesWithItAlone) {
  const ShellField field(test::wires(32, 0.2f));
  std::vector<ShellWay> ways;
  for (uint64_t i = 0; i < 700; ++i) {  // more than go together
    RandomStream numbers(7, i, 0);
    const Vec2 place = numbers.next2(), turn = numbers.next2();
    const ShellRay ray{place, Vec2(std::cos(6 * turn.x), std::sin(6 * turn.x)), 0.05f + 0.95f * turn.y,
                       i % 3 == 0 ? 0.0f : 2 * numbers.next() - 1, 1};
    const float end = span_of(ray, field.volume()).end;
    if (i % 2 == 0) {
      ways.emplace_back(ray, field.volume(), 0, end);
    } else {
      ways.emplace_back(ray, field.volume(), 0.6f * end, 0, true, ShellEdge{0.05f, 0.05f * (numbers.next() - 0.5f)});
    }
  }
  std::vector<ShellHit> hits(ways.size());
  trace_shells(field, ways, hits.data());
  int met = 0;
  for (size_t i = 0; i < ways.size(); ++i) {
    const ShellHit alone = trace_shell(field, ways[i]);
    ASSERT_EQ(hits[i].met, alone.met) << i;
    EXPECT_EQ(hits[i].begin, alone.begin) << i;
    if (!alone) continue;
    EXPECT_EQ(hits[i].s, alone.s) << i;
    EXPECT_EQ(hits[i].place, alone.place) << i;
    ++met;
  }
  EXPECT_GT(met, 150);
  EXPECT_LT(met, 550);
}

TEST(TraceShell, ARayThatStartsOnTheStructureLeavesItFirst) {
  const ShellField field(test::wires(64, 0.2f));
  const VotfVolume& volume = field.volume();
  const ShellRay ray{{0.5f, 0.5f}, {1, 0}, 1.0f, 0.0f, 1};
  const float surface = volume.top - 0.2f, pitch = volume.pitch();
  EXPECT_FALSE(trace_shell(field, {ray, volume, surface + pitch, 0, true}));
  EXPECT_TRUE(trace_shell(field, {ray, volume, surface + pitch, 0, false}));
  EXPECT_TRUE(trace_shell(field, {ray, volume, surface + 6 * pitch, 0, true})) << "deeper than arcs disagree";
}

TEST(ShellField, AnswersWhereverItIsAsked) {
  const ShellField field(test::wires(16, 0.2f));
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const float far : {-0.0f, -1e-9f, 1.0f - 0x1p-24f, -7.5f, 1e9f, -1e30f, infinity, nan}) {
    EXPECT_LE(std::abs(field.distance({far, far, 0})), field.volume().reach * 1.01f) << far;
    EXPECT_LE(std::abs(field.distance({0, 0, far == far ? far : 0})), field.volume().reach * 1.01f) << far;
  }
  EXPECT_NEAR(field.distance({0.5f, 0.3f, 0}), field.distance({-6.5f, 12.3f, 0}), 1e-4f);
}

TEST(ShellField, HasTheOutwardNormalAsItsGradient) {
  const ShellField field(test::wires(64, 0.2f));
  const Vec3 normal = glm::normalize(field.gradient({0.5f + 0.14f, 0.3f, 0.14f}));
  EXPECT_NEAR(normal.x, std::sqrt(0.5f), 0.02f);
  EXPECT_NEAR(normal.y, 0, 0.02f);
  EXPECT_NEAR(normal.z, std::sqrt(0.5f), 0.02f);
}

}  // namespace
}  // namespace velour::shell_trace_test
