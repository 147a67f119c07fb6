#include "capture/tile/bodies.h"

#include <gtest/gtest.h>

#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

const TileShape kShape = {.size = 4, .count = 4, .resolution = 12, .thickness = 0.26};  // pitch 1

Vec3d point(const Ring& ring, double t) {
  return ring.center + ring.radius * (std::cos(t) * ring.side + std::sin(t) * ring.along);
}

/// True where `a` passes through the disk of `b` an odd number of times.
bool linked(const Ring& a, const Ring& b) {
  int passes = 0;
  constexpr int kSteps = 360;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3d p = point(a, 2 * kPiD * (i + 0.5) / kSteps), q = point(a, 2 * kPiD * (i + 1.5) / kSteps);
    const double before = glm::dot(p - b.center, b.axis), after = glm::dot(q - b.center, b.axis);
    if ((before > 0) == (after > 0)) continue;
    const Vec3d through = glm::mix(p, q, before / (before - after));
    passes += glm::length(through - b.center) < b.radius;
  }
  return passes % 2 == 1;
}

double distance(const Ring& a, const Ring& b) {
  double least = 1e9;
  constexpr int kSteps = 240;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      least = std::min(least, glm::length(point(a, 2 * kPiD * i / kSteps) - point(b, 2 * kPiD * j / kSteps)));
    }
  }
  return least;
}

/// Rings around that of column 0, row `row`, copies of the tile included.
std::vector<Ring> neighbors(int row) {
  std::vector<Ring> rings;
  for (int dy = -3; dy <= 3; ++dy) {
    for (int dx = -3; dx <= 3; ++dx) {
      if (dx != 0 || dy != 0) rings.push_back(ring_at(kShape, dx, row + dy));
    }
  }
  return rings;
}

TEST(Chainmail, EachRingPassesThroughFourOthers) {
  for (int row : {0, 1}) {
    const Ring ring = ring_at(kShape, 0, row);
    int links = 0;
    for (const Ring& other : neighbors(row)) links += linked(ring, other);
    EXPECT_EQ(links, 4);
  }
}

TEST(Chainmail, TheThickestWireHasRoom) {
  for (int row : {0, 1}) {
    double least = 1e9;
    for (const Ring& other : neighbors(row)) least = std::min(least, distance(ring_at(kShape, 0, row), other));
    EXPECT_GT(least, kThickestWire);
    EXPECT_LT(least, 1.05 * kThickestWire);
  }
}

TEST(Chainmail, HasTheVolumeAndAreaOfItsTori) {
  const Tile tile = make_tile({.kind = "chainmail"});
  const TileShape& s = tile.shape;
  const double wire = 0.5 * s.thickness * s.pitch(), radius = kRingRadius * s.pitch();
  const int rings = s.count * s.count;
  const double steps = double(tile.parts.mesh.positions.size()) / (rings * s.resolution);
  // A polygon carried around a polygon.
  const double torus = wire * wire * polygon_area(s.resolution) * radius * steps * std::sin(2 * kPiD / steps);
  EXPECT_NEAR(volume(tile.parts.mesh, {0}) / (rings * torus), 1, 1e-5);
  EXPECT_NEAR(area(tile.parts.mesh, {0}) / (rings * 4 * kPiD * kPiD * wire * radius), 1, 0.02);
}

}  // namespace
}  // namespace velour::testing
