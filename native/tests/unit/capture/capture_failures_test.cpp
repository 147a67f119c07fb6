// Tiles that no one would model on purpose.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "capture/btf/tile_checks.h"
#include "material/principled/principled_material.h"
#include "support/captured.h"

namespace velour::capture_failures_test {
namespace {

using test::Captured;
using test::Corners;
using test::small_capture;
using test::tile_of;

/// A rough white surface, painted with a picture of 2 x 1 texels.
std::shared_ptr<const Material> painted(const Rgb& left, const Rgb& right) {
  const auto picture = std::make_shared<Texture<Rgb>>(2, 1, std::vector<Rgb>{left, right},
                                                      TextureOptions{.filter = TextureFilter::closest});
  return make_principled_material({.roughness = 1, .specular = 0}, {.base_color = {picture}}, 1);
}

/// The unit square; its texture coordinates are its x and y.
Mesh square(bool mapped) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<glm::uvec3> triangles{{0, 1, 2}, {0, 2, 3}};
  const std::vector<Vec2> uvs{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  return Mesh({.positions = positions,
               .triangles = triangles,
               .corner_uvs = mapped ? std::span<const Vec2>(uvs) : std::span<const Vec2>()});
}

TEST(CaptureFailures, TexelsOfATextureThatAreNoNumbersAreBlackAndAlone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  BtfCaptureOptions options = small_capture({{0, 0}, {60, 40}}, {{30, 0}});
  options.sampling.bounces = 2;
  const Captured broken(*tile_of(square(true), painted({nan, 1, 1}, Rgb(0.5f))), options, "nan");
  const Captured black(*tile_of(square(true), painted(Rgb(0), Rgb(0.5f))), options, "black");
  EXPECT_EQ(broken.values, black.values);
  EXPECT_EQ(broken.green(0, 0), 0);
  EXPECT_NEAR(broken.green(0, 15), 0.5f / kPi, 1e-3f);
}

TEST(CaptureFailures, WithoutTextureCoordinatesATextureHasOneColor) {
  const Captured captured(*tile_of(square(false), painted(Rgb(0.25f), Rgb(0.5f))), small_capture({{0, 0}}, {{30, 0}}),
                          "unmapped");
  for (size_t t = 0; t < captured.texels; ++t) EXPECT_EQ(captured.green(0, t), captured.green(0, 0));
  EXPECT_GT(captured.green(0, 0), 0);
}

TEST(CaptureFailures, OneDirectionIsEnough) {
  BtfCaptureOptions options = small_capture({{0, 0}}, {{0, 0}});
  options.reference_height.reset();
  const Captured captured(*tile_of(test::sawtooth(), std::make_shared<test::Lambert>(0.5f)), options, "one");
  EXPECT_EQ(captured.report.pairs, 1u);
  EXPECT_NEAR(captured.mean(0).mean, 0.5 / kPiD * (0.5 + 0.5), 0.1) << "faces of 45 degrees, and what they bounce";
}

// A ramp without a back, and a square that it pierces; both reach over the border of the cell.
TEST(CaptureFailures, WhatCrossesItselfAndTheBorderIsFiniteFromBothSides) {
  Corners corners;
  corners.quad({1.2f, 0, -0.3f}, {0.4f, 0, 0.4f}, {0.4f, 1, 0.4f}, {1.2f, 1, -0.3f});
  corners.rectangle(0.5f, 0, 1.5f, 1, 0.1f);
  BtfCaptureOptions options = small_capture({{0, 0}, {70, 10}}, {{0, 0}, {70, 190}});
  options.sides = CaptureSides::two;
  options.sampling.bounces = 4;
  const Captured captured(*tile_of(corners.mesh(), std::make_shared<test::Lambert>(1.0f)), options, "crossing");
  EXPECT_TRUE(captured.report.two_sided);
  for (const float value : captured.values) EXPECT_TRUE(std::isfinite(value) && value >= 0);
  for (size_t pair = 0; pair < 16; ++pair) {
    const bool same_side = (pair / 4 < 2) == (pair % 4 < 2);
    EXPECT_EQ(captured.mean(pair).mean > 0.05, same_side) << pair;
  }
}

std::string hash_of(Mesh mesh, std::shared_ptr<const Material> material) {
  const auto scene = tile_of(std::move(mesh), std::move(material));
  Progress progress;
  return tile_hash(RepeatedTile(*scene, place_of(*scene, {}), 1), progress);
}

/// A resumed capture must not go on with another tile, even if only details of its surface have changed.
TEST(TileHash, ChangesWithWhatTheTileLooksLike) {
  const Rgb dark(0.2f), bright(0.6f);
  const std::string one = hash_of(square(true), painted(dark, bright));
  EXPECT_EQ(hash_of(square(true), painted(dark, bright)), one);
  EXPECT_NE(hash_of(square(true), painted(bright, dark)), one) << "texture, with the same mean";
  EXPECT_NE(hash_of(square(false), painted(dark, bright)), one) << "texture coordinates";
  Corners flat;
  flat.rectangle(0, 0, 1, 1);
  const std::vector<Vec3> normals(6, glm::normalize(Vec3(0.4f, 0, 1)));
  const Mesh tilted({.positions = flat.positions, .triangles = flat.triangles, .corner_normals = normals});
  const auto white = std::make_shared<test::Lambert>(0.5f);
  EXPECT_NE(hash_of(tilted, white), hash_of(flat.mesh(), white)) << "normals";
  const auto thin = [](float alpha) { return std::make_shared<test::ThinLambert>(0.5f, alpha); };
  EXPECT_NE(hash_of(flat.mesh(), thin(0.5f)), hash_of(flat.mesh(), thin(0.51f))) << "cutouts";
}

}  // namespace
}  // namespace velour::capture_failures_test
