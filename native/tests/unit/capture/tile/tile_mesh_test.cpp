// What holds for the mesh of every tile.
#include <gtest/gtest.h>

#include "scene/mesh.h"
#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

class EveryTile : public ::testing::TestWithParam<TileKind> {
 protected:
  Tile tile_ = make_tile({.kind = GetParam().name});
  const TileMesh& mesh_ = tile_.parts.mesh;
};

TEST_P(EveryTile, IsAMeshThatRaysCanMeet) {
  const size_t n = mesh_.triangles.size();
  EXPECT_GE(n, 10000u);
  EXPECT_LE(n, 50000u);
  const Mesh mesh({.positions = mesh_.positions,
                   .triangles = mesh_.triangles,
                   .corner_normals = mesh_.corner_normals,
                   .corner_uvs = mesh_.corner_uvs,
                   .material_slots = mesh_.slots});
  EXPECT_EQ(mesh.dropped(), 0u);
  const double cell = tile_.shape.pitch() / tile_.shape.resolution;
  for (size_t i = 0; i < n; ++i) ASSERT_GT(glm::length(area_normal(mesh_, i)), 1e-3 * cell * cell) << i;
}

TEST_P(EveryTile, NormalsAreUnitAndOfTheirTrianglesSide) {
  for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Vec3d flat = glm::normalize(area_normal(mesh_, i));
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d smooth(mesh_.corner_normals[3 * i + k]);
      ASSERT_NEAR(glm::length(smooth), 1, 1e-5);
      ASSERT_GT(glm::dot(smooth, flat), 0.5) << "triangle " << i;
    }
  }
}

TEST_P(EveryTile, EachSlotHasAMaterialAndEachMaterialASlot) {
  std::vector<int> used(tile_.parts.materials.size(), 0);
  for (uint32_t slot : mesh_.slots) {
    ASSERT_LT(slot, used.size());
    ++used[slot];
  }
  for (size_t i = 0; i < used.size(); ++i) EXPECT_GT(used[i], 0) << tile_.parts.materials[i].name;
}

TEST_P(EveryTile, CoordinatesOfTexturesGoAroundOnce) {
  for (const Vec2& uv : mesh_.corner_uvs) {
    ASSERT_GE(std::min(uv.x, uv.y), 0);
    ASSERT_LE(std::max(uv.x, uv.y), 1);
  }
  for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Vec2* uv = &mesh_.corner_uvs[3 * i];
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    ASSERT_GT(a.x * b.y - a.y * b.x, 0) << "triangle " << i << " is mirrored or flat in the texture";
  }
}

/// The border edge that is `edge` moved by one period, walked the other way.
const Edge* partner(const TileMesh& mesh, const std::vector<Edge>& border, const Edge& edge, const Vec3d& step) {
  const auto near = [&](uint32_t a, uint32_t b) {
    return glm::length(Vec3d(mesh.positions[a]) + step - Vec3d(mesh.positions[b])) < 1e-6 * glm::length(step);
  };
  for (const Edge& other : border) {
    if (near(edge.from.vertex, other.to.vertex) && near(edge.to.vertex, other.from.vertex)) return &other;
  }
  return nullptr;
}

TEST_P(EveryTile, HasNoEdgeThatItsCopiesDoNotClose) {
  const Edges found = edges(mesh_);
  EXPECT_EQ(found.walked_twice, 0u);
  const Vec3d x(tile_.period.x, 0, 0), y(0, tile_.period.y, 0);
  for (const Edge& edge : found.border) {
    const Edge* other = nullptr;
    for (const Vec3d& step : {x, -x, y, -y}) other = other ? other : partner(mesh_, found.border, edge, step);
    ASSERT_NE(other, nullptr) << "at " << mesh_.positions[edge.from.vertex].x << ", "
                              << mesh_.positions[edge.from.vertex].y;
    EXPECT_EQ(mesh_.corner_normals[edge.from.corner], mesh_.corner_normals[other->to.corner]);
    EXPECT_EQ(mesh_.corner_normals[edge.to.corner], mesh_.corner_normals[other->from.corner]);
  }
}

TEST_P(EveryTile, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Tile again = make_tile({.kind = GetParam().name});
  EXPECT_EQ(again.parts.mesh.positions, mesh_.positions);
  EXPECT_EQ(again.parts.mesh.corner_normals, mesh_.corner_normals);
  const Tile other = make_tile({.kind = GetParam().name, .seed = 1});
  const bool chance = GetParam().defaults.irregularity > 0;
  EXPECT_EQ(other.parts.mesh.positions != mesh_.positions, chance);
}

TEST_P(EveryTile, GrowsWithItsSize) {
  const Tile large = make_tile({.kind = GetParam().name, .size = 8 * tile_.shape.size});
  ASSERT_EQ(large.parts.mesh.positions.size(), mesh_.positions.size());
  for (size_t i = 0; i < mesh_.positions.size(); ++i) {
    ASSERT_LT(glm::length(large.parts.mesh.positions[i] / 8.0f - mesh_.positions[i]), 1e-6 * tile_.shape.size);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryTile, ::testing::ValuesIn(tile_kinds().begin(), tile_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace velour::testing
