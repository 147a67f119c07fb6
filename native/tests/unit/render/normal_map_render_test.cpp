// Surfaces with normal maps in a scene: which way their relief lies, and that light stays where the surface is.
#include <gtest/gtest.h>

#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "support/textured_scenes.h"

namespace velour::normal_map_render_test {
namespace {

SurfaceMaterial white(const std::vector<Vec3>& normals, int side) {
  std::vector<Rgb> texels;
  for (const Vec3& n : normals) texels.push_back(0.5f + 0.5f * n);
  const auto texture =
      std::make_shared<const Texture<Rgb>>(side, side, texels, TextureOptions{.filter = TextureFilter::closest});
  return {.material = make_normal_mapped(make_principled_material({.base_color = Rgb(1), .specular = 0}),
                                         {{texture, {}}, 1}, ReliefPart::lobe),
          .rec709_colors = false,
          .relief = true};
}

/// From where it shines, without a shadow: what stops light is the surface alone.
Light sun_from(const Vec3& towards) {
  const Frame frame = Frame::about(glm::normalize(towards));
  Light sun;
  sun.color = Rgb(1);
  sun.casts_shadow = false;
  for (int i = 0; i < 3; ++i) {
    sun.light_to_world.m[4 * i] = frame.x[i];
    sun.light_to_world.m[4 * i + 1] = frame.y[i];
    sun.light_to_world.m[4 * i + 2] = frame.z[i];
  }
  return sun;
}

double seen(Mesh mesh, const Affine& place, const SurfaceMaterial& material, const Vec3& eye, const Vec3& sun) {
  Scene scene;
  scene.add_instance(scene.add_mesh(std::move(mesh)), place, {scene.add_material(material)});
  scene.add_light(sun_from(sun));
  scene.set_camera(Camera::look_at(eye, {0, 0, 0}, {0.1f, 1, 0.2f}, 0.6f, 1));
  scene.commit(1);
  RenderOptions options = test::small_options(Strategy::cosine, 64);
  return test::mean_of(test::rendered(scene, options));
}

const Vec3 kTilt = glm::normalize(Vec3(0.5f, 0.3f, 1)), kSun = glm::normalize(Vec3(0.2f, -0.4f, 1));

double plane(const Mat2& map, const Affine& place, const Vec3& eye, const Vec3& sun = kSun) {
  return seen(test::textured_square(5, map), place, white({kTilt}, 1), eye, sun);
}

/// f cos of a white surface with that normal.
double lit(const Vec3& normal, const Vec3& sun = kSun) {
  return static_cast<double>(std::max(glm::dot(normal, sun), 0.0f) / kPi);
}

TEST(NormalMapRender, ReliefLiesAlongTheTexture) {
  const Vec3 above(0, 0, 4);
  EXPECT_NEAR(plane(Mat2(1), {}, above), lit(kTilt), 1e-4);
  EXPECT_NEAR(plane(Mat2(0, 1, -1, 0), {}, above), lit({kTilt.y, -kTilt.x, kTilt.z}), 1e-4);
  EXPECT_NEAR(plane(Mat2(-1, 0, 0, 1), {}, above), lit({-kTilt.x, kTilt.y, kTilt.z}), 1e-4);
}

/// From behind one sees the relief's other side: the normal that the front has, turned round.
TEST(NormalMapRender, BehindItIsTheSameRelief) {
  const Vec3 sun(kSun.x, kSun.y, -kSun.z);
  EXPECT_NEAR(plane(Mat2(1), {}, {0, 0, -4}, sun), lit(-kTilt, sun), 1e-4);
  const Affine mirror = test::shift(Vec3(0.0f), {1, 1, -1});
  EXPECT_NEAR(plane(Mat2(1), mirror, {0, 0, -4}, sun), lit({kTilt.x, kTilt.y, -kTilt.z}, sun), 1e-4);
}

TEST(NormalMapRender, ScaleTurnsReliefAsNormals) {
  const Affine place = test::shift(Vec3(0.0f), {2, 0.5f, 1});
  EXPECT_NEAR(plane(Mat2(1), place, {0, 0, 4}), lit(glm::normalize(Vec3(kTilt.x / 2, kTilt.y * 2, kTilt.z))), 1e-4);
}

TEST(NormalMapRender, WithoutTextureCoordinatesItIsFlat) {
  EXPECT_NEAR(seen(test::square(5), {}, white({kTilt}, 1), {0, 0, 4}, kSun), lit({0, 0, 1}), 1e-4);
}

/// The mapped normal faces the sun, the surface does not.
TEST(NormalMapRender, NoLightComesFromBelowTheSurface) {
  const SurfaceMaterial steep = white({glm::normalize(Vec3(1.5f, 0, 1))}, 1);
  const auto light = [&](float height) {
    return seen(test::textured_square(5, Mat2(1)), {}, steep, {0, 0, 4}, {1, 0, height});
  };
  EXPECT_EQ(light(-0.05f), 0);
  EXPECT_GT(light(0.05f), 0.1);
}

/// A coarse sphere with smooth normals and steep random relief, from behind the sun: no triangle there faces it.
TEST(NormalMapRender, NoLightComesThroughACoarseSphere) {
  std::vector<Vec3> normals;
  for (uint64_t i = 0; i < 64; ++i) normals.push_back(sample_cosine_hemisphere(RandomStream(3, 0, i).next2()));
  const auto light = [&](float x) {
    return seen(test::textured_sphere(4), {}, white(normals, 8), {x, 0, 0}, {1, 0, 0});
  };
  EXPECT_EQ(light(-4), 0);
  EXPECT_GT(light(4), 0.02);
}

}  // namespace
}  // namespace velour::normal_map_render_test
