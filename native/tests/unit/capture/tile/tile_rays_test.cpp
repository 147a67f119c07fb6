// Rays through repeated tiles: each enters a solid only outside of every other.
#include <gtest/gtest.h>

#include "scene/embree_scene.h"
#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

/// 7 x 7 copies; the rays begin over the one in the middle.
class RepeatedTile {
 public:
  explicit RepeatedTile(const Tile& tile) : tile_(tile) {
    const uint32_t mesh = scene_.add_mesh(tile.parts.mesh.positions, tile.parts.mesh.triangles);
    for (int i = 0; i < 49; ++i) {
      Affine map;
      map.m[3] = float(i % 7 - 3) * tile.period.x;
      map.m[7] = float(i / 7 - 3) * tile.period.y;
      scene_.add_instance(mesh, map);
    }
    scene_.commit(1);
  }

  struct Crossing {
    int deepest = 0;     // solids that the ray was in at once
    int shallowest = 0;  // below 0: it left what it had not entered
    int end = 0;
    double overlap = 0;  // length within two solids or more
  };
  /// `u` in [0, 1)^2 of the middle cell, where the ray crosses z = 0.
  Crossing cross(const Vec2& u, const Vec3& direction) const {
    const float size = tile_.period.x;
    const Vec3 ground(u.x * tile_.period.x, u.y * tile_.period.y, 0);
    Ray ray{.origin = ground - direction * (2 * size), .direction = direction};
    Crossing crossing;
    Hit hit;
    for (scene_.intersect(ray, hit); hit.instance != kNoHit; scene_.intersect(ray, hit)) {
      if (crossing.end > 1) crossing.overlap += double(hit.distance - ray.near);
      crossing.end += glm::dot(hit.geometric_normal, direction) < 0 ? 1 : -1;
      crossing.deepest = std::max(crossing.deepest, crossing.end);
      crossing.shallowest = std::min(crossing.shallowest, crossing.end);
      ray.near = hit.distance + 1e-6f * size;
    }
    return crossing;
  }

 private:
  const Tile& tile_;
  EmbreeScene scene_;
};

constexpr int kRays = 128;  // a side

/// Off the lattice of the mesh, so that no ray runs along an edge.
Vec2 place(int i, int j) { return {(float(i) + 0.437f) / kRays, (float(j) + 0.613f) / kRays}; }

struct Passed {
  double open = 0;  // share of rays that met nothing
  double longest_overlap = 0;
  double unsound = 0;  // share of rays that left what they had not entered, or did not end outside (or in the ground)
};
Passed pass(const Tile& tile, const Vec3& direction) {
  const RepeatedTile repeated(tile);
  Passed passed;
  for (int i = 0; i < kRays; ++i) {
    for (int j = 0; j < kRays; ++j) {
      const RepeatedTile::Crossing c = repeated.cross(place(i, j), direction);
      passed.open += c.deepest == 0;
      passed.longest_overlap = std::max(passed.longest_overlap, c.overlap);
      passed.unsound += c.shallowest < 0 || c.end != (tile.parts.open ? 0 : 1);
    }
  }
  passed.open /= kRays * kRays;
  passed.unsound /= kRays * kRays;
  return passed;
}

const Vec3 kDirections[] = {{0, 0, -1}, {0.3f, 0.4f, -0.866f}, {-0.6f, 0.1f, -0.794f}};

class TileRays : public ::testing::TestWithParam<TileKind> {};

TEST_P(TileRays, EnterOneSolidAtATime) {
  const Tile tile = make_tile({.kind = GetParam().name});
  for (const Vec3& direction : kDirections) {
    const Passed passed = pass(tile, glm::normalize(direction));
    // Chords of curved middle lines cut a little into what touches them.
    EXPECT_LT(passed.longest_overlap, 0.02 * tile.shape.thickness * tile.shape.pitch());
    // Rays that graze an edge may miss one of its sides.
    EXPECT_LT(passed.unsound, 1e-3);
    const bool vertical = direction.x == 0;
    EXPECT_EQ(passed.open > 0 && vertical, tile.parts.open && vertical);
  }
}

class OpenArea : public ::testing::TestWithParam<const char*> {};

TEST_P(OpenArea, IsWhatRaysFind) {
  const Tile tile = make_tile({.kind = GetParam(), .irregularity = 0.0});
  ASSERT_TRUE(tile.parts.open_area.has_value());
  EXPECT_NEAR(pass(tile, {0, 0, -1}).open, *tile.parts.open_area, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TileRays, ::testing::ValuesIn(tile_kinds().begin(), tile_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

INSTANTIATE_TEST_SUITE_P(Kinds, OpenArea,
                         ::testing::Values("weave", "twill", "net", "gravel", "corduroy", "satin", "velvet",
                                           "leather"));

TEST(RaysThroughTiles, YarnsThatAreTooHighForTheirWaveAreFound) {
  // The negative control: the weft sinks by a tenth of the yarns' height.
  Tile tile = make_tile({.kind = "weave"});
  TileMesh& mesh = tile.parts.mesh;
  const auto sink = static_cast<float>(0.1 * tile.shape.thickness * tile.shape.pitch());
  std::vector<uint8_t> moved(mesh.positions.size(), 0);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3 && mesh.slots[i] == 1; ++k) moved[mesh.triangles[i][k]] = 1;
  }
  for (size_t i = 0; i < moved.size(); ++i) mesh.positions[i].z -= moved[i] ? sink : 0.0f;
  EXPECT_GT(pass(tile, {0, 0, -1}).longest_overlap, 0.02 * tile.shape.thickness * tile.shape.pitch());
}

TEST(OpenAreaOfANet, FewerPassAWiderCord) {
  const Tile wide = make_tile({.kind = "net", .thickness = 0.5, .gap = 0.4});
  EXPECT_NEAR(*wide.parts.open_area, 0.16, 1e-12);
  EXPECT_NEAR(pass(wide, {0, 0, -1}).open, 0.16, 0.01);
}

}  // namespace
}  // namespace velour::testing
