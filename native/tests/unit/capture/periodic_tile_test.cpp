#include "capture/goniometer/height_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sphere/random.h"

namespace velour::periodic_tile_test {
namespace {

constexpr int kCells = 32;

HeightField rough(double anisotropy) { return make_height_field({kCells, 3, 0.6, anisotropy}, 4, 0); }

/// Many periods as one plain mesh, seen from the middle one: what the tile must agree with.
EmbreeScene& plain_copy(const HeightField& field, EmbreeScene& scene) {
  constexpr int reach = 8 * kCells, side = 2 * reach + kCells;
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (int y = -reach; y <= kCells + reach; ++y) {
    for (int x = -reach; x <= kCells + reach; ++x) {
      const auto wrap = [](int i) { return ((i % kCells) + kCells) % kCells; };
      positions.emplace_back(static_cast<float>(x), static_cast<float>(y * field.cell_y), field.at(wrap(x), wrap(y)));
    }
  }
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t v = y * (side + 1) + x;
      triangles.emplace_back(v, v + 1, v + side + 2);
      triangles.emplace_back(v, v + side + 2, v + side + 1);
    }
  }
  scene.add_instance(scene.add_mesh(positions, triangles), {});
  scene.commit(1);
  return scene;
}

TEST(PeriodicTile, TracesAsTheSameSurfaceRepeatedWould) {
  for (const double anisotropy : {1.0, 3.0}) {
    const HeightField field = rough(anisotropy);
    const PeriodicTile tile(field, {});
    EmbreeScene scene;
    plain_copy(field, scene);
    int disagree = 0, blocked = 0;
    constexpr int rays = 20'000;
    for (uint64_t i = 0; i < rays; ++i) {
      RandomStream random(6, 7, i);
      const FacetPoint start = tile.point_above(random.next2());
      // Up to 84 degrees from the normal, so that the copy's edge is out of reach.
      const Vec3 w = direction(1.47f * random.next(), 2 * kPi * random.next());
      const bool expected = !scene.occluded({start.position, 0, w});
      const bool seen = tile.escapes(start.position, w);
      FacetPoint hit;
      EXPECT_EQ(tile.trace(start.position, w, hit) == Fate::escaped, seen);
      disagree += seen != expected;
      blocked += !seen;
    }
    EXPECT_LE(disagree, 2);  // rounding of rays that graze an edge
    EXPECT_GT(blocked, rays / 20);
  }
}

TEST(PeriodicTile, HitsLieJustAboveTheFacetTheyName) {
  const PeriodicTile tile(rough(2.0), {});
  for (uint64_t i = 0; i < 5000; ++i) {
    RandomStream random(8, 9, i);
    const FacetPoint start = tile.point_above(random.next2());
    const Vec3 down = -direction(1.5f * random.next(), 2 * kPi * random.next());
    FacetPoint hit;
    const Vec3 far_above = start.position + Vec3(0, 0, 50);
    ASSERT_EQ(tile.trace(far_above, down, hit), Fate::hit);
    EXPECT_GT(glm::dot(hit.normal, -down), -1e-5f);
    EXPECT_GT(hit.normal.z, 0.0f);
    EXPECT_TRUE(tile.escapes(hit.position, {0, 0, 1}));
    FacetPoint again;  // straight down from just above the surface: the same place
    ASSERT_EQ(tile.trace(hit.position, {0, 0, -1}, again), Fate::hit);
    EXPECT_NEAR(again.position.z, hit.position.z, 1e-3);
  }
}

TEST(PeriodicTile, PointsAboveAgreeWithVerticalRays) {
  const PeriodicTile tile(rough(1.0), {});
  for (uint64_t i = 0; i < 2000; ++i) {
    const FacetPoint point = tile.point_above(RandomStream(1, 1, i).next2());
    FacetPoint hit;
    ASSERT_EQ(tile.trace(point.position + Vec3(0, 0, 20), {0, 0, -1}, hit), Fate::hit);
    EXPECT_NEAR(hit.position.z, point.position.z, 2e-3);
  }
}

TEST(PeriodicTile, AFlatSurfaceHidesNothing) {
  const PeriodicTile tile(HeightField{kCells, 1.0, std::vector<float>(kCells * kCells, 0.0f)}, {});
  const FacetPoint point = tile.point_above({0.3f, 0.9f});
  EXPECT_EQ(point.normal, Vec3(0, 0, 1));
  EXPECT_TRUE(tile.escapes(point.position, glm::normalize(Vec3(1, 0.3f, 1e-3f))));
  FacetPoint hit;
  EXPECT_EQ(tile.trace(point.position, glm::normalize(Vec3(1, 0.3f, -1e-3f)), hit), Fate::hit);
  EXPECT_EQ(tile.trace({1, 1, -1}, {0, 0, -1}, hit), Fate::lost);  // below the surface
}

TEST(PeriodicTile, BaseCellsMarkBothTheirFacets) {
  std::vector<uint8_t> base(kCells * kCells, 0);
  base[5 * kCells + 7] = 1;
  const PeriodicTile tile(rough(1.0), base);
  int marked = 0;
  for (int facet = 0; facet < tile.facets(); ++facet) marked += tile.is_base(facet);
  EXPECT_EQ(marked, 2);
  EXPECT_TRUE(tile.point_above({7.2f / kCells, 5.7f / kCells}).base);
  EXPECT_FALSE(tile.point_above({5.7f / kCells, 7.2f / kCells}).base);
}

}  // namespace
}  // namespace velour::periodic_tile_test
