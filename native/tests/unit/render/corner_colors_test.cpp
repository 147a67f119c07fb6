// Materials that look at the colors of a mesh's corners.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "render/lights/emissive_meshes.h"
#include "render/path/vertex.h"
#include "support/textured_scenes.h"

namespace velour::corner_colors_test {
namespace {

const std::vector<Vec3> kPositions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
const std::vector<glm::uvec3> kTriangles = {{0, 1, 2}, {0, 2, 3}};
const Rgb kColor(0.7f, 0.2f, 0.4f);

/// A square with these colors of its six corners, one set after the other.
Mesh square_with(const std::vector<Rgb>& colors) {
  return Mesh({.positions = kPositions, .triangles = kTriangles, .corner_colors = colors});
}

std::vector<Rgb> sets_of(std::initializer_list<Rgb> colors) {
  std::vector<Rgb> all;
  for (const Rgb& color : colors) all.insert(all.end(), 6, color);
  return all;
}

SurfaceMaterial with_base(const TextureSlot<Rgb>& base, const Rgb& otherwise = Rgb(0.5f)) {
  PrincipledTextures textures;
  textures.base_color = base;
  MeshSets sets;
  sets.add(base);
  return {.material = make_principled_material({.base_color = otherwise}, textures, 1),
          .rec709_colors = false,
          .uv_sets = sets.uvs,
          .color_sets = sets.colors};
}

std::vector<float> picture(Mesh mesh, SurfaceMaterial material) {
  Scene scene;
  scene.add_instance(scene.add_mesh(std::move(mesh)), Affine{}, {scene.add_material(std::move(material))});
  Light lamp;
  lamp.light_to_world = {{1, 0, 0, 0, 0, 0.8f, 0.6f, 0, 0, -0.6f, 0.8f, 0}};
  scene.add_light(lamp);
  scene.set_camera(Camera::look_at({0.5f, -4, 3}, {0, 0, 0}, {0, 0, 1}, 0.9f, 1));
  scene.commit(1);
  std::vector<float> pixels = test::rendered(scene, test::small_options(Strategy::cosine, 16));
  for (size_t i = 3; i < pixels.size(); i += 4) pixels[i] = 0;  // of alpha nothing is asked here
  return pixels;
}

/// Shading frames of materials that vary are others, so that results round differently.
float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

constexpr float kRounding = 1e-5f, kSeen = 1e-2f;

TEST(CornerColors, OneColorOnAllCornersIsThatOfTheMaterial) {
  const auto plain = picture(square_with({}), with_base({}, kColor));
  EXPECT_GT(*std::ranges::max_element(plain), 0.1f);
  const auto slot = [](size_t set) { return with_base(TextureSlot<Rgb>::colors_of_corners(set)); };
  EXPECT_LT(largest_difference(picture(square_with(sets_of({kColor})), slot(0)), plain), kRounding);
  const Mesh third = square_with(sets_of({Rgb(0.9f), Rgb(0.1f), kColor}));
  EXPECT_LT(largest_difference(picture(third, slot(2)), plain), kRounding);
  EXPECT_GT(largest_difference(picture(third, slot(0)), plain), kSeen);
}

TEST(CornerColors, ASetThatIsNotThereIsBlack) {
  const auto black = picture(square_with({}), with_base({}, Rgb(0.0f)));
  const auto missing = with_base(TextureSlot<Rgb>::colors_of_corners(1));
  EXPECT_EQ(picture(square_with({}), missing), black);
  EXPECT_EQ(picture(square_with(sets_of({kColor})), missing), black);
}

TEST(CornerColors, AreInterpolatedAndStayWithTheTrianglesThatAreKept) {
  const std::vector<glm::uvec3> triangles = {{0, 0, 1}, {0, 1, 2}};  // the first has no area
  std::vector<Rgb> colors(12, Rgb(9));
  colors[3] = Rgb(1, 0, 0);
  colors[4] = Rgb(0, 2, 0);
  colors[5] = Rgb(0, 0, 4);
  colors[9] = Rgb(std::numeric_limits<float>::quiet_NaN(), 1, 1);
  const Mesh mesh({.positions = kPositions, .triangles = triangles, .corner_colors = colors});
  ASSERT_EQ(mesh.triangles().size(), 1u);
  EXPECT_EQ(mesh.color(0, {0.25f, 0.25f}, 0), Rgb(0.5f, 0.5f, 1.0f));
  EXPECT_EQ(mesh.color(0, {0, 0}, 1), Rgb(0));
  EXPECT_EQ(mesh.color(0, {1, 0}, 1), Rgb(9));
  EXPECT_EQ(mesh.color(0, {1, 0}, 2), Rgb(0));
}

/// Given by the corners of faces, as all that is of corners.
TEST(CornerColors, MayBeOfTheCornersOfFaces) {
  const std::vector<glm::uvec3> triangles = {{3, 0, 1}, {3, 1, 2}};
  const std::vector<uint32_t> vertices = {1, 2, 3, 0};
  const std::vector<Rgb> colors = {Rgb(1), Rgb(2), Rgb(3), Rgb(4)};
  const Mesh mesh(
      {.positions = kPositions, .triangles = triangles, .corner_colors = colors, .corner_vertices = vertices});
  EXPECT_EQ(mesh.color(0, {0, 0}, 0), Rgb(4));
  EXPECT_EQ(mesh.color(1, {0, 1}, 0), Rgb(3));
}

TEST(CornerColors, MustBeWholeSets) {
  EXPECT_THROW(square_with(std::vector<Rgb>(7)), Error);
  EXPECT_NO_THROW(square_with(std::vector<Rgb>(12)));
}

TEST(CornerColors, AreNumbersByTheirFirstChannel) {
  PrincipledTextures holes;
  holes.alpha = TextureSlot<float>::colors_of_corners(0);
  const SurfaceMaterial cut_out{.material = make_principled_material({.base_color = kColor}, holes, 1),
                                .rec709_colors = false,
                                .uv_sets = 0,
                                .color_sets = 1};
  const auto whole = picture(square_with({}), with_base({}, kColor));
  EXPECT_LT(largest_difference(picture(square_with(sets_of({Rgb(1, 0, 0)})), cut_out), whole), kRounding);
  const auto open = picture(square_with(sets_of({Rgb(0, 1, 1)})), cut_out);
  EXPECT_EQ(*std::ranges::max_element(open), 0.0f);
}

TEST(CornerColors, NeedNoTextureCoordinates) {
  for (const bool by_picture : {false, true}) {
    const auto texture = std::make_shared<const Texture<Rgb>>(1, 1, std::vector<Rgb>{kColor}, TextureOptions{});
    Scene scene;
    const auto slot = by_picture ? TextureSlot<Rgb>(texture) : TextureSlot<Rgb>::colors_of_corners(0);
    scene.add_instance(scene.add_mesh(square_with(sets_of({kColor}))), Affine{}, {scene.add_material(with_base(slot))});
    scene.commit(1);
    EXPECT_EQ(untextured_instances(scene), by_picture ? 1u : 0u);
  }
}

/// Rays are drawn to triangles as bright as their corners make them, and to none that are black.
TEST(CornerColors, TellHowMuchTrianglesEmit) {
  ShaderLayers layers;
  layers.emissive.push_back({Rgb(1), TextureSlot<Rgb>::colors_of_corners(0)});
  const SurfaceMaterial emissive{
      .material = make_layered_material(layers), .rec709_colors = false, .uv_sets = 0, .color_sets = 1};
  const auto group_of = [&](const std::vector<Rgb>& colors) {
    Scene scene;
    scene.add_instance(scene.add_mesh(square_with(colors)), Affine{}, {scene.add_material(emissive)});
    scene.commit(1);
    return EmissiveGroup(scene, scene.instances()[0], Progress());
  };
  const EmissiveGroup half = group_of({Rgb(3), Rgb(3), Rgb(3), Rgb(0), Rgb(0), Rgb(0)});
  EXPECT_NE(half.light(0), EmissiveGroup::kNone);
  EXPECT_EQ(half.light(1), EmissiveGroup::kNone);
  const EmissiveGroup both = group_of({Rgb(4), Rgb(4), Rgb(4), Rgb(0), Rgb(0), Rgb(3)});
  EXPECT_FLOAT_EQ(both.tree().intensity(both.light(0)), 2 * 4);  // area times luminance
  EXPECT_FLOAT_EQ(both.tree().intensity(both.light(1)), 2 * 1);
  const EmissiveGroup below = group_of({Rgb(-9), Rgb(1), Rgb(1), Rgb(1), Rgb(1), Rgb(1)});
  EXPECT_NE(below.light(0), EmissiveGroup::kNone);  // its mean is below zero, two of its corners shine
}

}  // namespace
}  // namespace velour::corner_colors_test
