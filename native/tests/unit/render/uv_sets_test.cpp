// Materials that look at several sets of texture coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "support/textured_scenes.h"

namespace velour::uv_sets_test {
namespace {

const Mat2 kFirst(0.3f, 0.1f, -0.2f, 0.5f), kSecond(1.7f, 0.4f, 0.6f, -2.1f);

std::vector<Vec2> uvs_of(const Mesh& mesh) {
  std::vector<Vec2> uvs;
  for (uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    for (const Vec2& uv : mesh.corner_uvs(t)) uvs.push_back(uv);
  }
  return uvs;
}

/// A square on the ground with these sets.
Mesh square_with(const Mat2& first, const std::vector<Mat2>& more, const Mat2* relief = nullptr) {
  const Mesh square = test::textured_square(5, first);
  std::vector<Vec2> others, of_relief;
  for (const Mat2& map : more) {
    for (const Vec2& uv : uvs_of(test::textured_square(5, map))) others.push_back(uv);
  }
  if (relief != nullptr) of_relief = uvs_of(test::textured_square(5, *relief));
  const std::vector<Vec2> uvs = uvs_of(square);
  return Mesh({.positions = square.positions(),
               .triangles = square.triangles(),
               .corner_uvs = uvs,
               .more_uvs = others,
               .relief_uvs = of_relief});
}

std::shared_ptr<const Texture<Rgb>> colors() {
  const std::vector<Rgb> texels = {{0.9f, 0.1f, 0.2f}, {0.1f, 0.8f, 0.3f}, {0.2f, 0.3f, 0.7f}, {0.6f, 0.6f, 0.1f}};
  return std::make_shared<const Texture<Rgb>>(2, 2, texels, TextureOptions{});
}

std::vector<float> picture(Mesh mesh, SurfaceMaterial material) {
  Scene scene;
  scene.add_instance(scene.add_mesh(std::move(mesh)), Affine{}, {scene.add_material(std::move(material))});
  Light lamp;
  lamp.light_to_world = {{1, 0, 0, 0, 0, 0.8f, 0.6f, 0, 0, -0.6f, 0.8f, 0}};
  scene.add_light(lamp);
  scene.set_camera(Camera::look_at({0.5f, -4, 3}, {0, 0, 0}, {0, 0, 1}, 0.9f, 1));
  scene.commit(1);
  return test::rendered(scene, test::small_options(Strategy::cosine, 16));
}

SurfaceMaterial colored(size_t set, uint8_t sets) {
  PrincipledTextures textures;
  textures.base_color = {colors(), {}, set};
  return {.material = make_principled_material({}, textures, 1), .rec709_colors = false, .uv_sets = sets};
}

/// Shading frames follow the first set, so that results round differently.
float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

constexpr float kRounding = 1e-5f, kSeen = 1e-2f;

TEST(UvSets, APictureOnASecondSetLooksAsOnAFirst) {
  const auto alone = picture(square_with(kSecond, {}), colored(0, 1));
  EXPECT_LT(largest_difference(picture(square_with(kFirst, {kSecond}), colored(1, 2)), alone), kRounding);
  EXPECT_LT(largest_difference(picture(square_with(kFirst, {kFirst, kSecond}), colored(2, 3)), alone), kRounding);
  EXPECT_GT(largest_difference(picture(square_with(kFirst, {kSecond}), colored(0, 2)), alone), kSeen);
}

SurfaceMaterial cut_out(size_t set, uint8_t sets) {
  const std::vector<float> holes = {1, 0, 0, 1};
  PrincipledTextures textures;
  textures.alpha = {std::make_shared<const Texture<float>>(2, 2, holes, TextureOptions{}), {}, set};
  return {.material = make_principled_material({.base_color = Rgb(0.8f)}, textures, 1),
          .rec709_colors = false,
          .uv_sets = sets};
}

/// Rays that pass, and shadows, look at the sets as well.
TEST(UvSets, HolesOnASecondSetAreWhereTheyAreOnAFirst) {
  const auto alone = picture(square_with(kSecond, {}), cut_out(0, 1));
  EXPECT_LT(largest_difference(picture(square_with(kFirst, {kSecond}), cut_out(1, 2)), alone), kRounding);
  EXPECT_GT(largest_difference(picture(square_with(kFirst, {kSecond}), cut_out(0, 2)), alone), kSeen);
}

TEST(UvSets, OneThatIsNotThereIsTheFirst) {
  EXPECT_EQ(picture(square_with(kFirst, {}), colored(2, 3)), picture(square_with(kFirst, {}), colored(0, 1)));
}

TEST(UvSets, ReliefFollowsItsOwn) {
  const std::vector<Rgb> tilt = {0.5f + 0.5f * glm::normalize(Vec3(0.5f, 0.3f, 1))};
  const auto map = std::make_shared<const Texture<Rgb>>(1, 1, tilt, TextureOptions{});
  const SurfaceMaterial bumpy{.material = make_normal_mapped(make_principled_material({.base_color = Rgb(1)}),
                                                             {{map, {}}, 1}, ReliefPart::lobe),
                              .rec709_colors = false,
                              .relief = true};
  const auto alone = picture(square_with(kSecond, {}), bumpy);
  EXPECT_LT(largest_difference(picture(square_with(kFirst, {}, &kSecond), bumpy), alone), kRounding);
  EXPECT_GT(largest_difference(picture(square_with(kFirst, {}), bumpy), alone), kSeen);
}

TEST(UvSets, StayWithTheTrianglesThatAreKept) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::uvec3> t = {{0, 0, 1}, {0, 1, 2}};  // the first has no area
  std::vector<Vec2> uvs(6), more(12);
  for (size_t i = 0; i < more.size(); ++i) more[i] = Vec2(static_cast<float>(i), 0);
  const Mesh mesh({.positions = p, .triangles = t, .corner_uvs = uvs, .more_uvs = more});
  ASSERT_EQ(mesh.triangles().size(), 1u);
  EXPECT_EQ(mesh.corner_uvs(0, 1)[2], Vec2(5, 0));
  EXPECT_EQ(mesh.corner_uvs(0, 2)[0], Vec2(9, 0));
}

TEST(UvSets, MustBeWhole) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}};
  const std::vector<Vec2> uvs(3), part(4);
  EXPECT_THROW(Mesh({.positions = p, .triangles = t, .corner_uvs = uvs, .more_uvs = part}), Error);
  EXPECT_THROW(Mesh({.positions = p, .triangles = t, .more_uvs = uvs}), Error);
  EXPECT_THROW(Mesh({.positions = p, .triangles = t, .corner_uvs = uvs, .relief_uvs = part}), Error);
  EXPECT_NO_THROW(Mesh({.positions = p, .triangles = t, .corner_uvs = uvs, .more_uvs = uvs, .relief_uvs = uvs}));
}

}  // namespace
}  // namespace velour::uv_sets_test
