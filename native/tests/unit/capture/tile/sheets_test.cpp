#include "capture/tile/fabrics.h"

#include <gtest/gtest.h>

#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

TEST(Corduroy, WithoutIrregularityIsParabolas) {
  const Tile tile = make_tile({.kind = "corduroy", .irregularity = 0.0});
  const TileShape& s = tile.shape;
  const int steps = s.resolution - 1;  // the last one crosses the groove
  const double a = 0.5 * (1 - s.gap) * s.pitch(), b = s.thickness * s.pitch();
  double section = 0;
  for (int i = 0; i < steps; ++i) {
    const double left = std::cos(kPiD * i / steps), right = std::cos(kPiD * (i + 1) / steps);
    section += a * (left - right) * b * (1 - 0.5 * (left * left + right * right));
  }
  EXPECT_NEAR(volume(tile.parts.mesh, {0}) / (s.count * s.size * section), 1, 1e-5);
}

TEST(Leather, WithoutIrregularityIsSquareCushions) {
  const Tile tile = make_tile({.kind = "leather", .irregularity = 0.0, .resolution = 32});
  const TileShape& s = tile.shape;
  const double height = s.thickness * s.pitch(), side = s.pitch(), crease = 0.5 * s.gap * s.pitch();
  // A square with a flat top, whose border rises as 3 t^2 - 2 t^3: the height integrated over the level lines, squares.
  double expected = height * std::pow(side - 2 * crease, 2);
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    expected += height * t * t * (3 - 2 * t) * 4 * (side - 2 * crease * t) * crease / kSteps;
  }
  EXPECT_NEAR(volume(tile.parts.mesh, {0}) / (s.count * s.count * expected), 1, 0.01);
}

TEST(Leather, StaysBetweenTheCreasesAndTheHighestCushion) {
  const Tile tile = make_tile({.kind = "leather"});
  const double height = tile.shape.thickness * tile.shape.pitch();
  double low = height, high = 0;
  for (const Vec3& p : tile.parts.mesh.positions) {
    low = std::min(low, double(p.z));
    high = std::max(high, double(p.z));
  }
  EXPECT_LE(high, height * (1 + 1e-6));
  EXPECT_GT(high, 0.9 * height);
  EXPECT_LT(low, 0.4 * height);
  EXPECT_GE(low, 0);
}

}  // namespace
}  // namespace velour::testing
