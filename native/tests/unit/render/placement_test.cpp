// Texture placements of instances: a placed mesh is the mesh whose texture coordinates were moved before.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "btf/eval/factored_material.h"
#include "material/principled/principled_material.h"
#include "render/path/vertex.h"
#include "support/example_btf.h"
#include "support/textured_scenes.h"

namespace velour::placement_test {
namespace {

constexpr int kPlacedPixels = 24;

Mat2 turned(float angle, const Vec2& scale) {
  const float c = std::cos(angle), s = std::sin(angle);
  return Mat2(c * scale.x, -s * scale.y, s * scale.x, c * scale.y);
}

const TextureMap kPlacements[] = {{turned(0.6f, {2.7f, 2.7f}), {0.3f, -1.2f}},
                                  {turned(-2.0f, {5.0f, 1.5f}), {-7.1f, 0.4f}},
                                  {Mat2(0, 2, 3, 0), {0, 0}},         // mirrored
                                  {Mat2(1, 0.2f, 0.9f, 1), {0, 0}}};  // sheared

/// `mesh` with texture coordinates that were taken through `map`.
Mesh moved(const Mesh& mesh, const TextureMap& map) {
  std::vector<Vec2> uvs;
  for (uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    for (const Vec2& uv : mesh.corner_uvs(t)) uvs.push_back(map.point(uv));
  }
  return Mesh({.positions = mesh.positions(), .triangles = mesh.triangles(), .corner_uvs = uvs});
}

Affine bent() {
  Affine map = test::shift({0.1f, -0.2f, 0.3f}, {-1.2f, 0.7f, 1});
  map.m[1] = 0.4f;  // sheared and mirrored
  return map;
}

/// One instance of `mesh` under a sky and a lamp from one side.
Scene lit(const Mesh& mesh, std::shared_ptr<const Material> material, const Affine& place,
          std::vector<TextureMap> placements) {
  Scene scene;
  scene.add_instance(scene.add_mesh(mesh), place, {scene.add_material({std::move(material), Rgb(0.0f), false})},
                     std::move(placements));
  scene.set_environment(Environment::constant(Rgb(0.3f)));
  Light lamp;
  lamp.type = Light::Type::rectangle;
  lamp.color = Rgb(60);
  lamp.light_to_world = {{1, 0, 0, 0, 0, 0.8f, 0.6f, 1.8f, 0, -0.6f, 0.8f, 2.4f}};  // beside, turned to the origin
  scene.add_light(lamp);
  scene.set_camera(Camera::look_at({0.5f, -2, 3}, {0, 0, 0}, {0, 0, 1}, 0.5f, 1));
  scene.commit(1);
  return scene;
}

std::vector<float> picture(const Scene& scene, int spp = 64) {
  RenderOptions options = test::small_options(Strategy::mis, spp);
  options.width = options.height = kPlacedPixels;
  return test::rendered(scene, options);
}

/// The largest difference of two pictures over the mean of the first.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double worst = 0, sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, static_cast<double>(std::abs(a[i] - b[i])));
    sum += a[i];
  }
  return worst * static_cast<double>(a.size()) / sum;
}

std::shared_ptr<const Material> btf() {
  return make_factored_material(std::make_shared<const FactoredBtf>(test::example_factored()));
}

/// Squares of paint and of holes.
std::shared_ptr<const Material> cut_out() {
  const std::vector<Rgb> colors{{0.9f, 0.5f, 0.2f}, Rgb(0.1f), Rgb(0.8f), {0.2f, 0.4f, 0.9f}};
  const std::vector<float> alphas{1, 0, 1, 1};
  return make_principled_material(
      {},
      {.base_color = {std::make_shared<const Texture<Rgb>>(2, 2, colors, TextureOptions{}), {}},
       .alpha = {std::make_shared<const Texture<float>>(2, 2, alphas, TextureOptions{}), {}}},
      1);
}

/// Vertices of a grid of camera rays; nothing where they miss.
std::vector<std::optional<Vertex>> placed_vertices(const Scene& scene) {
  std::vector<std::optional<Vertex>> all;
  const PixelFootprint pixel(scene, kPlacedPixels, kPlacedPixels, 1);
  for (int i = 0; i < kPlacedPixels * kPlacedPixels; ++i) {
    const Ray ray = scene.camera().ray(Vec2(static_cast<float>(i % kPlacedPixels) + 0.5f,  //
                                            static_cast<float>(i / kPlacedPixels) + 0.5f) /
                                       static_cast<float>(kPlacedPixels));
    Hit hit;
    scene.rays().intersect(ray, hit);
    if (hit.instance == kNoHit) {
      all.emplace_back();
    } else {
      all.emplace_back(Vertex(scene, scene.surface(hit), ray, hit, pixel.cone(ray.direction), &pixel));
    }
  }
  return all;
}

TEST(Placement, IsTheMeshWithMovedCoordinates) {
  const Mesh mesh = test::textured_sphere(12);
  for (const TextureMap& map : kPlacements) {
    const auto placed = placed_vertices(lit(mesh, btf(), bent(), {map}));
    const auto expected = placed_vertices(lit(moved(mesh, map), btf(), bent(), {}));
    int met = 0;
    for (size_t i = 0; i < placed.size(); ++i) {
      ASSERT_EQ(placed[i].has_value(), expected[i].has_value());
      if (!placed[i]) continue;
      ++met;
      EXPECT_LT(glm::distance(placed[i]->site.uv, expected[i]->site.uv), 2e-5f);
      for (int side = 0; side < 2; ++side) {
        const Vec2 is = placed[i]->site.footprint[side], should = expected[i]->site.footprint[side];
        EXPECT_LT(glm::distance(is, should), 1e-3f * glm::length(should) + 1e-7f);
      }
      EXPECT_GT(glm::dot(placed[i]->frame.x, expected[i]->frame.x), 0.99999f);
      EXPECT_GT(glm::dot(placed[i]->frame.y, expected[i]->frame.y), 0.99999f);
    }
    EXPECT_GT(met, 100);
  }
}

TEST(Placement, PicturesAreThoseOfMovedCoordinates) {
  const Mesh mesh = test::repeating_square(1, 1);
  for (const auto& material : {btf(), cut_out()}) {
    const auto unplaced = picture(lit(mesh, material, {}, {}));
    for (const TextureMap& map : kPlacements) {
      const auto placed = picture(lit(mesh, material, {}, {map}));
      EXPECT_LT(difference(picture(lit(moved(mesh, map), material, {}, {})), placed), 1e-3);
      EXPECT_GT(difference(unplaced, placed), 0.05);  // and the placement is seen
    }
  }
}

TEST(Placement, OfNothingKeepsEveryBit) {
  const Mesh mesh = test::textured_sphere(8);
  EXPECT_EQ(picture(lit(mesh, btf(), {}, {TextureMap{}})), picture(lit(mesh, btf(), {}, {})));
}

/// A placement turns the tangent, too: a turned object under the lamp that stays is the turned texture.
TEST(Placement, TurnsAnAnisotropicBtfAsIfTheSurfaceWereTurned) {
  const Mesh mesh = test::repeating_square(1, 1);
  const TextureMap quarter{Mat2(0, -1, 1, 0), {0, 0}};  // the texture by 90 degrees, counter-clockwise
  const Affine turned_object{{0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}};
  const auto of_texture = picture(lit(mesh, btf(), {}, {quarter}), 1024);
  const auto of_object = picture(lit(mesh, btf(), turned_object, {}), 1024);
  EXPECT_LT(difference(of_object, of_texture), 1e-3);
  EXPECT_GT(difference(picture(lit(mesh, btf(), {}, {}), 1024), of_texture), 0.05);
}

TEST(Placement, ScalesTheFootprint) {
  const Mesh mesh = test::repeating_square(1, 1);
  const auto plain = placed_vertices(lit(mesh, btf(), {}, {}));
  const auto repeated = placed_vertices(lit(mesh, btf(), {}, {{turned(0.6f, {4, 4}), {0, 0}}}));
  for (size_t i = 0; i < plain.size(); ++i) {
    if (!plain[i]) continue;
    for (int side = 0; side < 2; ++side) {
      const float length = glm::length(plain[i]->site.footprint[side]);
      EXPECT_NEAR(glm::length(repeated[i]->site.footprint[side]), 4 * length, 1e-4f * length);
    }
  }
}

/// Few camera rays, thousands of tiles: only a footprint that scales finds the mean.
TEST(Placement, ManyTilesAreTheirMean) {
  const std::vector<Rgb> checker{Rgb(1), Rgb(0), Rgb(0), Rgb(1)};
  const auto matte = make_principled_material(
      {.specular = 0}, {.base_color = {std::make_shared<const Texture<Rgb>>(2, 2, checker, TextureOptions{}), {}}}, 1);
  Scene scene;
  scene.add_instance(scene.add_mesh(test::repeating_square(4, 1)), {}, {scene.add_material({matte, Rgb(0.0f), false})},
                     {{turned(0.3f, {3000, 3000}), {0, 0}}});
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  const auto pixels = test::rendered(scene, test::small_options(Strategy::cosine, 8));
  for (size_t i = 0; i < pixels.size(); i += 4) EXPECT_NEAR(pixels[i], 0.5f, 0.01f);
}

/// Neither the border of a tile nor the edge between two triangles shows: on either side it is the same, and by whole
/// tiles it may be moved.
TEST(Placement, HasNoSeams) {
  const Mesh mesh = test::repeating_square(1, 1);
  const TextureMap& map = kPlacements[0];
  const Scene scene = lit(mesh, btf(), {}, {map});
  ScratchArena arena;
  const Vec3 wl = direction(0.7f, 2.0f);
  const auto seen = [&](const Vec2& xy) {
    const Ray ray{{xy, 1}, 0, {0, 0, -1}};
    Hit hit;
    scene.rays().intersect(ray, hit);
    const Vertex vertex(scene, scene.surface(hit), ray, hit, {}, nullptr);
    arena.reset();
    return vertex.surface->material->prepare(vertex.wv, vertex.site, {}, arena)->eval_one(vertex.frame.to_local(wl)).f;
  };
  const Mat2 to_square = 2.0f * glm::inverse(map.map);  // of a step in tiles
  const Vec2 middle = map.point(Vec2(0.5f)), corner(std::round(middle.x), std::floor(middle.y));
  float across_tile = 0, within = 0, across_diagonal = 0;
  for (int i = 0; i < 50; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / 50;
    const Vec2 border = to_square * (corner + Vec2(0, t) - map.shift) - 1.0f, step = to_square * Vec2(1e-4f, 0);
    const Vec2 inside = border - to_square * Vec2(0.25f, 0);
    across_tile = std::max(across_tile, glm::distance(seen(border - step), seen(border + step)));
    within = std::max(within, glm::distance(seen(border), seen(inside)));
    const Vec2 edge(2 * t - 1), aside(1e-4f, -1e-4f);
    across_diagonal = std::max(across_diagonal, glm::distance(seen(edge - aside), seen(edge + aside)));
  }
  EXPECT_LT(across_tile, 5e-3f);
  EXPECT_LT(across_diagonal, 5e-3f);
  EXPECT_GT(within, 1e-2f);
  const TextureMap further{map.map, map.shift + Vec2(3, -2)};
  EXPECT_LT(difference(picture(scene), picture(lit(mesh, btf(), {}, {further}))), 1e-3);
}

TEST(Placement, IsOfItsSlotAndInstance) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  const std::vector<uint32_t> slots = {0, 5};
  Scene scene;
  const uint32_t mesh =
      scene.add_mesh(Mesh({.positions = p, .triangles = t, .corner_uvs = uvs, .material_slots = slots}));
  const uint32_t material = scene.add_material({btf(), Rgb(0.0f), true});
  scene.add_instance(mesh, {}, {material, material}, {{Mat2(2), {0, 0}}, {Mat2(3), {0, 0}}});
  scene.add_instance(mesh, test::shift({2, 0, 0}), {material});
  scene.commit(1);
  const auto uv_at = [&](float x, float y) {
    Hit hit;
    scene.rays().intersect({{x, y, 1}, 0, {0, 0, -1}}, hit);
    return scene.texture(hit).uv;
  };
  EXPECT_LT(glm::distance(uv_at(0.7f, 0.2f), Vec2(1.4f, 0.4f)), 1e-5f);
  EXPECT_LT(glm::distance(uv_at(0.2f, 0.7f), Vec2(0.6f, 2.1f)), 1e-5f);  // slot 5: the last entry
  EXPECT_LT(glm::distance(uv_at(2.7f, 0.2f), Vec2(0.7f, 0.2f)), 1e-5f);
}

TEST(Placement, WhatCannotBeIsRefused) {
  Scene scene;
  const uint32_t mesh = scene.add_mesh(test::repeating_square(1, 1));
  const uint32_t material = scene.add_material({btf(), Rgb(0.0f), true});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(scene.add_instance(mesh, {}, {material}, {TextureMap{}, TextureMap{}}), Error);
  EXPECT_THROW(scene.add_instance(mesh, {}, {material}, {{Mat2(0.0f), {0, 0}}}), Error);
  EXPECT_THROW(scene.add_instance(mesh, {}, {material}, {{Mat2(1, 2, 2, 4), {0, 0}}}), Error);
  EXPECT_THROW(scene.add_instance(mesh, {}, {material}, {{Mat2(1.0f), {0, nan}}}), Error);
  scene.add_instance(mesh, {}, {material}, {{Mat2(-1e-3f), {0, 0}}});
}

TEST(Placement, MeshesWithoutCoordinatesAreCounted) {
  Scene scene;
  const uint32_t bare = scene.add_mesh(test::square(1)), mapped = scene.add_mesh(test::repeating_square(1, 1));
  const uint32_t varying = scene.add_material({btf(), Rgb(0.0f), true});
  const uint32_t uniform = scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), true});
  scene.add_instance(bare, {}, {varying});
  scene.add_instance(bare, {}, {uniform});
  scene.add_instance(mapped, {}, {varying});
  EXPECT_EQ(untextured_instances(scene), 1u);
}

}  // namespace
}  // namespace velour::placement_test
