#include "capture/tile/fabrics.h"

#include <gtest/gtest.h>

#include "capture/tile/tile.h"
#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

/// The middle line of a course, in wales, as fabrics.h states it.
Vec3d middle(double t, double course) {
  return {t / (2 * kPiD) + kLoopWidth * std::sin(2 * t), kLoopHeight * std::cos(t) + course * kCourse,
          -kLoopDepth * std::cos(2 * t)};
}

/// Distance of the middle lines of two courses, or of the two sides of a loop: parts further apart along the line than
/// a yarn's own curvature reaches.
double clearance() {
  constexpr int kSteps = 240;
  double least = 1e9;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3d here = middle(2 * kPiD * i / kSteps, 0);
    for (int j = -kSteps; j < 2 * kSteps; ++j) {
      const double t = 2 * kPiD * j / kSteps;
      if (std::abs(j - i) > kSteps / 5) least = std::min(least, glm::length(here - middle(t, 0)));
      for (int course : {1, 2}) least = std::min(least, glm::length(here - middle(t, course)));
    }
  }
  return least;
}

TEST(Knit, TheThickestYarnHasRoom) {
  EXPECT_GT(clearance(), kThickestYarn);
  EXPECT_LT(clearance(), 1.06 * kThickestYarn);
}

/// Half the signed crossings, seen from above, of a course with the one `apart` courses further: above 0 where its
/// yarn passes over.
std::pair<int, int> crossings(int apart) {
  constexpr int kSteps = 720;
  int over = 0, under = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3d a = middle(2 * kPiD * i / kSteps, 0), b = middle(2 * kPiD * (i + 1) / kSteps, 0);
    for (int j = -kSteps; j < 2 * kSteps; ++j) {
      const Vec3d c = middle(2 * kPiD * j / kSteps, apart), d = middle(2 * kPiD * (j + 1) / kSteps, apart);
      const glm::dvec2 u(b - a), v(d - c), w(c - a);
      const double area = u.x * v.y - u.y * v.x;
      const double s = (w.x * v.y - w.y * v.x) / area, r = (w.x * u.y - w.y * u.x) / area;
      if (!(s >= 0 && s < 1 && r >= 0 && r < 1)) continue;
      (a.z + s * (b.z - a.z) > c.z + r * (d.z - c.z) ? over : under) += 1;
    }
  }
  return {over, under};
}

TEST(Knit, EachLoopHangsInTheNextCourse) {
  // A loop crosses the next course four times on each side of its head; without as many crossings over as under it
  // could be lifted off.
  const auto [over, under] = crossings(1);
  EXPECT_EQ(over, 2);
  EXPECT_EQ(under, 2);
  EXPECT_EQ(crossings(2), std::pair(0, 0));
}

TEST(Velvet, StandsAsHighAsItsThicknessAndLeansTogether) {
  const Tile upright = make_tile({.kind = "velvet", .irregularity = 0.0});
  const Tile leaning = make_tile({.kind = "velvet", .irregularity = 1.0});
  const double height = upright.shape.thickness * upright.shape.pitch();
  double highest = 0, furthest = 0;
  for (size_t i = 0; i < upright.parts.mesh.positions.size(); ++i) {
    const Vec3d p(upright.parts.mesh.positions[i]), q(leaning.parts.mesh.positions[i]);
    highest = std::max(highest, p.z);
    furthest = std::max(furthest, glm::length(p - q));
    EXPECT_EQ(p.z, q.z);
  }
  EXPECT_NEAR(highest / height, 1, 1e-6);
  EXPECT_GT(furthest, 0.1 * height);
  EXPECT_LT(furthest, std::sqrt(2.0) * 0.5 * height);
}

}  // namespace
}  // namespace velour::testing
