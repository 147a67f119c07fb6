#include "scene/mesh.h"

#include <gtest/gtest.h>

#include "support/textured_scenes.h"

namespace velour::corner_tangents_test {
namespace {

struct Corners {
  std::vector<Vec3> positions, normals;
  std::vector<glm::uvec3> triangles;
  std::vector<Vec2> uvs;
  std::vector<CornerTangent> tangents() const { return corner_tangents(positions, triangles, normals, uvs); }
};

/// Triangles of a plane z = 0; texture coordinates by `map`.
Corners flat(const std::vector<Vec3>& positions, const std::vector<glm::uvec3>& triangles, const Mat2& map) {
  Corners c{positions, {}, triangles, {}};
  for (const glm::uvec3& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      c.normals.emplace_back(0, 0, 1);
      c.uvs.push_back(map * Vec2(positions[t[k]]));
    }
  }
  return c;
}

const std::vector<Vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<glm::uvec3> kHalves = {{0, 1, 2}, {0, 2, 3}};

void expect_all(const std::vector<CornerTangent>& tangents, const Vec3& direction, float side) {
  for (const CornerTangent& t : tangents) {
    EXPECT_LT(glm::distance(t.direction, direction), 1e-6f);
    EXPECT_EQ(t.side, side);
  }
}

TEST(CornerTangents, FollowTheFirstCoordinate) {
  expect_all(flat(kSquare, kHalves, Mat2(1)).tangents(), {1, 0, 0}, 1);
  expect_all(flat(kSquare, kHalves, Mat2(0, 3, -3, 0)).tangents(), {0, -1, 0}, 1);  // turned
}

TEST(CornerTangents, KeepTheHandOfMirroredPictures) {
  expect_all(flat(kSquare, kHalves, Mat2(-2, 0, 0, 2)).tangents(), {-1, 0, 0}, -1);
  expect_all(flat(kSquare, kHalves, Mat2(1, 0, 0, -1)).tangents(), {1, 0, 0}, -1);
}

/// Two wings of a fold, of which one shows the picture mirrored: nothing is averaged over the seam.
TEST(CornerTangents, PartAtMirrorSeams) {
  const std::vector<Vec3> p = {{0, 0, 0}, {0, 1, 0}, {-1, 0.5f, 0}, {1, 0.5f, 0}};
  Corners c = flat(p, {{0, 3, 1}, {0, 1, 2}}, Mat2(1));
  for (Vec2& uv : c.uvs) uv.x = std::abs(uv.x);
  const auto tangents = c.tangents();
  expect_all({tangents.begin(), tangents.begin() + 3}, {1, 0, 0}, 1);
  expect_all({tangents.begin() + 3, tangents.end()}, {-1, 0, 0}, -1);
}

/// Where triangles of one side meet, each counts by its angle there.
TEST(CornerTangents, AreWeightedByAngles) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}};
  Corners c = flat(p, {{0, 1, 3}, {0, 3, 4}}, Mat2(1));
  const float turn = 0.6f;  // of the second triangle's picture, about the place (0, 0) that both share
  const Mat2 turned(std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn));
  for (size_t k = 3; k < 6; ++k) c.uvs[k] = turned * c.uvs[k];
  const auto tangents = c.tangents();
  const Vec3 second(std::cos(turn), -std::sin(turn), 0);
  const Vec3 expected = glm::normalize(2.0f * Vec3(1, 0, 0) + second);  // 90 and 45 degrees
  EXPECT_LT(glm::distance(tangents[0].direction, expected), 1e-6f);
  EXPECT_LT(glm::distance(tangents[3].direction, expected), 1e-6f);
  EXPECT_LT(glm::distance(tangents[1].direction, Vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(tangents[5].direction, second), 1e-6f);
}

TEST(CornerTangents, OfPicturesWithoutAreaAreFinite) {
  for (const CornerTangent& t : flat(kSquare, kHalves, Mat2(0)).tangents()) {
    EXPECT_NEAR(glm::length(t.direction), 1, 1e-6f);
    EXPECT_EQ(t.direction.z, 0);
  }
  Corners c = flat(kSquare, kHalves, Mat2(1));
  c.uvs[1].x = NAN;
  for (const CornerTangent& t : c.tangents()) EXPECT_NEAR(glm::length(t.direction), 1, 1e-6f);
}

TEST(CornerTangents, AreSmoothOnASphere) {
  Mesh mesh = test::textured_sphere(16);
  EXPECT_FALSE(mesh.has_tangents());
  mesh.make_tangents();
  ASSERT_TRUE(mesh.has_tangents());
  for (uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const Vec2 middle(1.0f / 3);
    const Vec3 p = mesh.position(t, middle);
    if (std::abs(p.z) > 0.9f) continue;  // longitudes meet at the poles
    const Mat3 relief = mesh.relief(t, middle);
    const Vec3 east = glm::normalize(Vec3(-p.y, p.x, 0)), tangent = glm::normalize(relief[0]);
    EXPECT_GT(std::abs(glm::dot(tangent, east)), 0.99f) << t;
    EXPECT_NEAR(glm::dot(tangent, glm::normalize(relief[2])), 0, 0.02f);
    EXPECT_GT(std::abs(glm::dot(glm::normalize(relief[1]), glm::cross(tangent, glm::normalize(p)))), 0.99f);
  }
}

TEST(CornerTangents, NeedTextureCoordinates) {
  Mesh mesh = test::sphere(4);
  mesh.make_tangents();
  EXPECT_FALSE(mesh.has_tangents());
}

}  // namespace
}  // namespace velour::corner_tangents_test
