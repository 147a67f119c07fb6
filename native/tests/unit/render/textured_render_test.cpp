// Pictures of textured planes, whose pixels are known.
#include <gtest/gtest.h>

#include "material/principled/principled_material.h"
#include "math/sphere/random.h"
#include "support/textured_scenes.h"

namespace velour::textured_render_test {
namespace {

constexpr int kPixels = 8;

Camera orthographic_above(float half) {
  Camera camera = test::camera_above(half);
  camera.type = Camera::Type::orthographic;
  camera.window[0] = camera.window[2] = -half;
  camera.window[1] = camera.window[3] = half;
  return camera;
}

std::vector<float> picture(std::shared_ptr<const Material> material, Mesh mesh, const Camera& camera, int spp = 64,
                           int bounces = 0) {
  Scene scene;
  scene.add_instance(scene.add_mesh(std::move(mesh)), {},
                     {scene.add_material({std::move(material), Rgb(0.0f), false})});
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(camera);
  scene.commit(1);
  RenderOptions options = test::small_options(Strategy::cosine, spp);
  options.bounces = bounces;
  return test::rendered(scene, options);
}

std::shared_ptr<const Material> matte(int width, int height, std::vector<Rgb> texels,
                                      const TextureOptions& options = {}) {
  const auto texture = std::make_shared<const Texture<Rgb>>(width, height, std::move(texels), options);
  return make_principled_material({.specular = 0}, {.base_color = {texture, {}}}, 1);
}

std::vector<Rgb> colors() {
  std::vector<Rgb> texels;
  for (int i = 0; i < kPixels * kPixels; ++i) {
    texels.emplace_back(static_cast<float>(i) / 64, static_cast<float>(i % 8) / 8, 0.5f);
  }
  return texels;
}

/// One texel a pixel, row 0 of both at the bottom.
TEST(TexturedRender, PixelsAreTheirTexels) {
  const auto texels = colors();
  const auto pixels = picture(matte(kPixels, kPixels, texels, {.filter = TextureFilter::closest}),
                              test::repeating_square(1, 1), orthographic_above(1));
  for (size_t i = 0; i < texels.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixels[4 * i + static_cast<size_t>(c)], texels[i][c], 1e-4f) << i;
  }
}

/// Linear between texels: a pixel's mean over nine of them has weights 1/8, 3/4, 1/8 each way.
TEST(TexturedRender, PixelsAreTheMeansOfTheInterpolant) {
  const auto texels = colors();
  const auto pixels =
      picture(matte(kPixels, kPixels, texels), test::repeating_square(1, 1), orthographic_above(1), 4096);
  const float weight[] = {0.125f, 0.75f, 0.125f};
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      Rgb expected(0);
      for (int k = 0; k < 9; ++k) {
        const int column = (x + k % 3 - 1 + kPixels) % kPixels, row = (y + k / 3 - 1 + kPixels) % kPixels;
        expected += weight[k % 3] * weight[k / 3] * texels[static_cast<size_t>(row * kPixels + column)];
      }
      const auto i = 4 * static_cast<size_t>(y * kPixels + x);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixels[i + static_cast<size_t>(c)], expected[c], 6e-3f) << x << ' ' << y;
    }
  }
}

std::vector<Rgb> checker(int side) {
  std::vector<Rgb> texels;
  for (int i = 0; i < side * side; ++i) texels.emplace_back(static_cast<float>((i + i / side) % 2));
  return texels;
}

/// A camera ray or two a pixel, and 32 texels: only the levels can know the mean.
TEST(TexturedRender, AMinifiedCheckerIsGray) {
  const auto pixels = picture(matte(64, 64, checker(64)), test::repeating_square(1, 4), test::camera_above(1), 8);
  for (size_t i = 0; i < pixels.size(); i += 4) EXPECT_NEAR(pixels[i], 0.5f, 0.01f);
}

TEST(TexturedRender, ControlWithoutAFootprintItIsNot) {
  class Pointwise final : public test::Varying {
   public:
    explicit Pointwise(std::shared_ptr<const Material> material) : Varying(0), material_(std::move(material)) {}
    const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                ScratchArena& arena) const override {
      return material_->prepare(wv, {.uv = site.uv}, options, arena);
    }

   private:
    std::shared_ptr<const Material> material_;
  };
  const auto pixels = picture(std::make_shared<Pointwise>(matte(64, 64, checker(64))), test::repeating_square(1, 4),
                              test::camera_above(1), 8);
  float worst = 0;
  for (size_t i = 0; i < pixels.size(); i += 4) worst = std::max(worst, std::abs(pixels[i] - 0.5f));
  EXPECT_GT(worst, 0.1f);
}

/// Reflects only light from the local +y: shows how the frame lies.
class Sided : public test::ChangedMaterial {
 public:
  explicit Sided(bool varies) : ChangedMaterial(std::make_shared<test::Lambert>(1.0f), darken), varies_(varies) {}
  bool varies() const override { return varies_; }

 private:
  static void darken(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& /*pdf*/) {
    for (int i = 0; i < wl.count; ++i) {
      if (!(wl.y[i] > 0)) f.set(i, Rgb(0.0f));
    }
  }

  bool varies_;
};

/// Radiance of a plane whose second texture coordinate grows to +y or -y, under a sun in the +y half.
double lit_from_y(bool varies, float v_sign) {
  Scene scene;
  const Mat2 map(1, 0, 0, v_sign);
  scene.add_instance(scene.add_mesh(test::textured_square(4, map)), {},
                     {scene.add_material({std::make_shared<Sided>(varies), Rgb(0.0f), false})});
  Light sun;
  sun.light_to_world = {{1, 0, 0, 0, 0, 0.8f, 0.6f, 0, 0, -0.6f, 0.8f, 0}};  // its +z, towards it: (0, 0.6, 0.8)
  scene.add_light(sun);
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  return test::mean_of(test::rendered(scene, test::small_options(Strategy::cosine)));
}

TEST(TexturedRender, MirroredTexturesAreLitAsTheyLook) {
  const double lit = 0.8 / static_cast<double>(kPi);
  EXPECT_NEAR(lit_from_y(true, 1), lit, 1e-4);
  EXPECT_EQ(lit_from_y(true, -1), 0);
  EXPECT_NEAR(lit_from_y(false, 1), lit, 1e-4);
  EXPECT_NEAR(lit_from_y(false, -1), lit, 1e-4);  // a uniform material cannot be mirrored
}

/// Rough and smooth, metal and not, from squares; lit by a sky and a lamp.
Scene patchwork() {
  const auto numbers = [](std::vector<float> texels) {
    return TextureSlot<float>{std::make_shared<const Texture<float>>(2, 2, std::move(texels), TextureOptions{}), {}};
  };
  const std::vector<Rgb> colors{{0.9f, 0.5f, 0.2f}, Rgb(0.1f), Rgb(0.8f), {0.2f, 0.4f, 0.9f}};
  Scene scene;
  scene.add_instance(scene.add_mesh(test::repeating_square(1, 2)), {},
                     {scene.add_material(
                         {make_principled_material(
                              {},
                              {.base_color = {std::make_shared<const Texture<Rgb>>(2, 2, colors, TextureOptions{}), {}},
                               .metallic = numbers({0, 1, 1, 0}),
                               .roughness = numbers({0.3f, 0.5f, 0.9f, 0.6f})},
                              1),
                          Rgb(0.0f), false})});
  std::vector<float> sky(3 * 16 * 8);
  RandomStream random(2, 2, 2);
  for (float& v : sky) v = random.next();
  scene.set_environment(Environment::image({16, 8, 3, sky}, 1, Mat3(1.0f)));
  Light lamp;
  lamp.type = Light::Type::rectangle;
  lamp.size = {2, 2};
  lamp.color = Rgb(20);
  lamp.light_to_world = test::shift({0.5f, 0, 2});
  scene.add_light(lamp);
  scene.set_camera(Camera::look_at({0, -3, 2}, {0, 0, 0}, {0, 0, 1}, 0.7f, 1));
  scene.commit(1);
  return scene;
}

/// Also those that know the whole material only: tables and fitted lobes.
TEST(TexturedRender, StrategiesAgree) {
  const Scene scene = patchwork();
  const double expected = test::mean_of(test::rendered(scene, test::small_options(Strategy::mis, 16384)));
  for (const Strategy strategy : {Strategy::uniform, Strategy::cosine, Strategy::table, Strategy::srbf, Strategy::light,
                                  Strategy::ggx, Strategy::mis_ggx, Strategy::product}) {
    EXPECT_NEAR(test::mean_of(test::rendered(scene, test::small_options(strategy, 16384))), expected, 4e-3 * expected)
        << static_cast<int>(strategy);
  }
}

TEST(TexturedRender, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = patchwork();
  RenderOptions options = test::small_options(Strategy::mis);
  options.bounces = 2;
  const auto two = test::rendered(scene, options);
  options.threads = 1;
  EXPECT_EQ(test::rendered(scene, options), two);
}

/// A black-and-white floor under a white lid that is seen from below: what the lid shows is the floor's mean.
double lid_over(std::shared_ptr<const Material> floor) {
  Scene scene;
  scene.add_instance(scene.add_mesh(test::repeating_square(20, 400)), {},
                     {scene.add_material({std::move(floor), Rgb(0.0f), false})});
  scene.add_instance(scene.add_mesh(test::square(1)), test::shift({0, 0, 1}),
                     {scene.add_material({std::make_shared<test::Lambert>(1.0f), Rgb(0.0f), false})});
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(Camera::look_at({0, 0, 0.2f}, {0, 0, 1}, {0, 1, 0}, 1, 1));
  scene.commit(1);
  RenderOptions options = test::small_options(Strategy::cosine, 4096);
  options.bounces = 1;
  return test::mean_of(test::rendered(scene, options));
}

TEST(TexturedRender, BouncesSeeTheTexture) {
  EXPECT_NEAR(lid_over(matte(2, 2, {Rgb(1), Rgb(0), Rgb(0), Rgb(1)})), lid_over(std::make_shared<test::Lambert>(0.5f)),
              2e-3);
}

}  // namespace
}  // namespace velour::textured_render_test
