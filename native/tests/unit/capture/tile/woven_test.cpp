#include "capture/tile/fabrics.h"

#include <gtest/gtest.h>

#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

TEST(Yarn, WaveGoesOnStraightAtBothEnds) {
  EXPECT_DOUBLE_EQ(yarn_wave(0), 1);
  EXPECT_NEAR(yarn_wave(0.5), 0, 1e-15);
  EXPECT_DOUBLE_EQ(yarn_wave(1), -1);
  for (double u : {0.1, 0.2, 0.37}) EXPECT_NEAR(yarn_wave(u), -yarn_wave(1 - u), 1e-15);
  const double h = 1e-3;  // slope and curvature there are of order h^3 and h^2
  EXPECT_NEAR((yarn_wave(h) - 1) / (h * h), 0, 1e-3);
  EXPECT_NEAR((yarn_wave(1 - h) + 1) / (h * h), 0, 1e-3);
}

TEST(Yarn, ClearsTheYarnThatItCrosses) {
  for (double half_width : {0.05, 0.2, 0.4, 0.45, 0.48}) {
    const double amplitude = yarn_amplitude(half_width);
    EXPECT_GE(amplitude, 1);
    double least = 1;
    for (int i = 0; i < 1000; ++i) {
      const double d = i / 1000.0;
      least = std::min(least, amplitude * yarn_wave(d * half_width) - std::sqrt(1 - d * d));
    }
    EXPECT_GT(least, -1e-4) << half_width;
    EXPECT_LT(least, 0.01) << "higher than it need be: " << half_width;
  }
}

class Cloth : public ::testing::TestWithParam<const char*> {};

TEST_P(Cloth, HasTheVolumeOfItsYarns) {
  // Sections are equal upright polygons however the middle runs, so the volume is exact (Cavalieri).
  const Tile tile = make_tile({.kind = GetParam(), .irregularity = 0.0});
  const TileShape& s = tile.shape;
  const double a = 0.5 * (1 - s.gap) * s.pitch(), b = 0.5 * s.thickness * s.pitch();
  const double expected = 2 * s.count * s.size * a * b * polygon_area(s.resolution);
  EXPECT_NEAR(volume(tile.parts.mesh, {0, 1}) / expected, 1, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Cloth, ::testing::Values("weave", "twill", "denim", "satin", "net"));

/// Height of the middle of yarn `yarn` above crossing `crossing`, from the vertices near it.
double middle(const Tile& tile, bool weft, int yarn, int crossing) {
  const TileMesh& mesh = tile.parts.mesh;
  const double pitch = tile.shape.pitch();
  double low = 1, high = -1;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    if ((mesh.slots[i] == 1) != weft) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = corner(mesh, i, k);
      const double along = weft ? p.x : p.y, across = weft ? p.y : p.x;
      if (std::abs(along - (crossing + 0.5) * pitch) > 1e-3 * pitch) continue;
      if (std::abs(across - (yarn + 0.5) * pitch) > 0.5 * pitch) continue;
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
  }
  return 0.5 * (low + high);
}

TEST(Cloth, PlainWeaveGoesOverOneUnderOne) {
  const Tile tile = make_tile({.kind = "weave"});
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double weft = middle(tile, true, i, j), warp = middle(tile, false, j, i);
      EXPECT_EQ(weft > 0, (i + j) % 2 == 0);
      EXPECT_LT(weft * warp, 0) << "one above, the other below";
    }
  }
}

TEST(Cloth, TwillGoesOverTwoUnderTwoAndShiftsByOne) {
  const Tile tile = make_tile({.kind = "twill"});
  for (int i = 0; i < 4; ++i) {
    int above = 0;
    for (int j = 0; j < 4; ++j) {
      const bool over = middle(tile, true, i, j) > 0;
      above += over;
      EXPECT_EQ(over, middle(tile, true, (i + 1) % 4, (j + 1) % 4) > 0);
      EXPECT_EQ(over, middle(tile, false, j, i) < 0);
    }
    EXPECT_EQ(above, 2);
  }
}

TEST(Cloth, DenimShowsThreeWarpsForEachWeft) {
  const Tile tile = make_tile({.kind = "denim"});
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) EXPECT_EQ(middle(tile, true, i, j) > 0, i == j);
  }
}

}  // namespace
}  // namespace velour::testing
