// Surfaces that are there in part: means of camera, shadow and bounce rays that are known.
#include <gtest/gtest.h>

#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "render/path/shadow_queue.h"
#include "support/textured_scenes.h"

namespace velour::transparency_test {
namespace {

constexpr float kAlbedo = 0.8f;

/// Matte; `alpha` of it is there, or of each of 2 x 2 squares.
SurfaceMaterial matte(float albedo, const std::vector<float>& alpha) {
  PrincipledTextures textures;
  if (alpha.size() > 1) {
    textures.alpha.texture =
        std::make_shared<const Texture<float>>(2, 2, alpha, TextureOptions{.filter = TextureFilter::closest});
  }
  return {make_principled_material({.base_color = Rgb(albedo), .specular = 0}, textures, alpha[0]), Rgb(0.0f), false};
}

void add(Scene& scene, Mesh mesh, const Affine& place, SurfaceMaterial material) {
  scene.add_instance(scene.add_mesh(std::move(mesh)), place, {scene.add_material(std::move(material))});
}

RenderOptions options_for(int spp, int bounces = 0) {
  RenderOptions options = test::small_options(Strategy::cosine, spp);
  options.bounces = bounces;
  options.transparent = true;
  return options;
}

Scene veil(const std::vector<float>& alpha, int layers = 1) {
  Scene scene;
  for (int i = 0; i < layers; ++i) {
    add(scene, test::repeating_square(2, 1), test::shift({0, 0, -0.5f * static_cast<float>(i)}), matte(kAlbedo, alpha));
  }
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  return scene;
}

/// A square of 0.8 over one of 0.4 under a sky of 1, of which something passes through the upper.
double seen_of_two(uint8_t hidden_from, float& alpha) {
  Scene scene;
  const uint32_t upper = scene.add_mesh(test::square(4)), lower = scene.add_mesh(test::square(8));
  scene.add_instance(upper, test::shift({0, 0, 0.001f}), {scene.add_material(matte(0.8f, {1}))}, {}, hidden_from);
  scene.add_instance(lower, {}, {scene.add_material(matte(0.4f, {1}))});
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  const auto pixels = test::rendered(scene, options_for(256));
  alpha = pixels[3];
  return test::mean_of(pixels);
}

TEST(Hidden, RaysPassWhatIsHiddenFromTheirKind) {
  float alpha;
  EXPECT_NEAR(seen_of_two(0, alpha), 0.8, 5e-3);
  EXPECT_NEAR(seen_of_two(hidden::kFromShadows, alpha), 0.8, 5e-3);
  EXPECT_NEAR(seen_of_two(hidden::kFromCamera, alpha), 0, 5e-3);  // in the shadow of what is not seen
  // Light of an even sky is found by bounces.
  EXPECT_NEAR(seen_of_two(hidden::kFromCamera | hidden::kFromShadows, alpha), 0, 5e-3);
  EXPECT_NEAR(seen_of_two(hidden::kFromCamera | hidden::kFromBounces, alpha), 0.4, 5e-3);
  EXPECT_EQ(alpha, 1);
  EXPECT_EQ(seen_of_two(hidden::kHoldout, alpha), 0);
  EXPECT_EQ(alpha, 0);
}

constexpr uint8_t kKinds[] = {hidden::kFromCamera, hidden::kFromBounces, hidden::kFromShadows,
                              hidden::kFromTransmission};

/// Two squares in one plane, one of them hidden from some rays. `veiled`: rays first pass a transparent surface.
struct Coincident {
  Scene scene;
  uint32_t shown;  // number of the other one

  Coincident(uint8_t hidden_from, bool shown_first, bool stays, bool veiled, uint8_t shown_hidden_from = 0)
      : shown(shown_first ? 0 : 1) {
    const uint32_t material = scene.add_material(matte(0.8f, {1}));
    for (uint32_t i = 0; i < 2; ++i) {
      scene.add_instance(scene.add_mesh(test::square(1)), test::shift({0, 0, 0.3f}), {material}, {},
                         i == shown ? shown_hidden_from : hidden_from);
    }
    if (veiled) {
      scene.add_instance(scene.add_mesh(test::square(2)), test::shift({0, 0, 0.5f}),
                         {scene.add_material(matte(0.8f, {0}))});
    }
    if (stays) scene.stay();
    scene.commit(1);
  }
};

TEST(Hidden, RaysMeetWhatLiesInAHiddenSurface) {
  std::vector<Ray> rays;
  std::vector<uint8_t> kinds;
  for (int i = 0; i < 64; ++i) {
    const Vec2 at = Vec2(0.11f * static_cast<float>(i % 8), 0.11f * static_cast<float>(i / 8)) - 0.4f;
    for (const uint8_t kind : kKinds) {
      rays.push_back({Vec3(at, 1), 0, {0, 0, -1}});
      kinds.push_back(kind);
    }
  }
  std::vector<Hit> hits(rays.size());
  std::vector<Rgb> passed(rays.size());
  std::vector<uint8_t> blocked(rays.size());
  for (const uint8_t hidden_from : kKinds) {
    for (int variant = 0; variant < 8; ++variant) {
      SCOPED_TRACE(testing::Message() << int{hidden_from} << ", variant " << variant);
      const bool shown_first = (variant & 1) != 0, stays = (variant & 2) != 0, veiled = (variant & 4) != 0;
      const Coincident two(hidden_from, shown_first, stays, veiled);
      const VisibleRays visible(two.scene);
      visible.intersect(rays, hits.data(), {.each = kinds}, passed.data());
      visible.occluded(rays, blocked.data(), passed.data());
      // Negative control: hidden from the same rays, the other surface is not met either.
      const Coincident none(hidden_from, shown_first, stays, veiled, hidden_from);
      std::vector<Hit> no_hits(rays.size());
      VisibleRays(none.scene).intersect(rays, no_hits.data(), {.each = kinds}, passed.data());
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_NE(hits[i].instance, kNoHit);
        EXPECT_NEAR(hits[i].distance, 0.7f, 1e-6f);
        EXPECT_TRUE(blocked[i]);
        EXPECT_TRUE(kinds[i] != hidden_from || hits[i].instance == two.shown);
        EXPECT_EQ(no_hits[i].instance == kNoHit, kinds[i] == hidden_from);
      }
    }
  }
}

/// A square that lies in a larger one over a floor.
TEST(Hidden, WhatIsHiddenFromAllRaysLeavesTheImageAsItIs) {
  const auto image = [](uint8_t hidden_from, bool has_larger) {
    Scene scene;
    const uint32_t material = scene.add_material(matte(0.8f, {1}));
    const auto add_square = [&](float half, float height, uint8_t hidden) {
      scene.add_instance(scene.add_mesh(test::square(half)), test::shift({0, 0, height}), {material}, {}, hidden);
    };
    add_square(0.5f, 0, 0);
    if (has_larger) add_square(4, 0, hidden_from);
    add_square(4, -0.5f, 0);
    scene.set_environment(Environment::constant(Rgb(1)));
    scene.set_camera(test::camera_above(1));
    scene.commit(1);
    return test::rendered(scene, options_for(16, 2));
  };
  constexpr uint8_t kAll = kKinds[0] | kKinds[1] | kKinds[2] | kKinds[3];
  EXPECT_EQ(image(kAll, true), image(0, false));
  // Negative control: seen by the camera alone, or by bounces alone.
  EXPECT_NE(image(kAll & ~hidden::kFromCamera, true), image(0, false));
  EXPECT_NE(image(kAll & ~hidden::kFromBounces, true), image(0, false));
}

/// A square beneath two emissive ones in one plane, of which bounces see one.
TEST(Hidden, BouncesFindTheLightThatLiesInAHiddenSurface) {
  const auto below = [](int lights, bool hidden_first, Strategy strategy) {
    Scene scene;
    SurfaceMaterial dim = matte(0, {1}), bright = dim;
    dim.emission = Rgb(1);
    bright.emission = Rgb(2);
    const uint32_t square = scene.add_mesh(test::square(1));
    const auto add_light = [&](const SurfaceMaterial& material, uint8_t hidden_from) {
      scene.add_instance(square, test::shift({0, 0, 1}), {scene.add_material(material)}, {}, hidden_from);
    };
    if (lights == 2 && hidden_first) add_light(bright, hidden::kFromCamera | hidden::kFromBounces);
    add_light(dim, hidden::kFromCamera);
    if (lights == 2 && !hidden_first) add_light(bright, hidden::kFromCamera | hidden::kFromBounces);
    scene.add_instance(scene.add_mesh(test::square(8)), {}, {scene.add_material(matte(0.4f, {1}))});
    scene.set_camera(test::camera_above(1));
    scene.commit(1);
    return test::mean_of(test::rendered(scene, test::small_options(strategy, 256)));
  };
  for (const Strategy strategy : {Strategy::cosine, Strategy::light, Strategy::mis}) {
    const double lit = below(1, false, strategy);
    EXPECT_GT(lit, 0.05);
    for (const bool hidden_first : {false, true}) EXPECT_NEAR(below(2, hidden_first, strategy), lit, 1e-3 * lit);
  }
}

/// The same, the upper one turned over or not, or mirrored, and from behind not there for some rays.
double seen_with_hidden_backs(const Affine& place, uint8_t hidden_from) {
  Scene scene;
  const uint32_t upper = scene.add_mesh(test::square(4)), lower = scene.add_mesh(test::square(8));
  scene.add_instance(upper, place, {scene.add_material(matte(0.8f, {1}))});
  scene.set_hidden_backs(0, hidden_from);
  scene.add_instance(lower, {}, {scene.add_material(matte(0.4f, {1}))});
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  return test::mean_of(test::rendered(scene, options_for(256)));
}

TEST(Hidden, RaysPassBacksThatAreHiddenFromTheirKind) {
  const Affine up = test::shift({0, 0, 0.001f});
  Affine down = up, mirrored = up;
  down.m[5] = down.m[10] = -1;
  mirrored.m[0] = -1;
  constexpr uint8_t kSeen = hidden::kFromCamera | hidden::kFromBounces;
  for (const Affine& front : {up, mirrored}) {
    EXPECT_NEAR(seen_with_hidden_backs(front, kSeen | hidden::kFromShadows), 0.8, 5e-3);
  }
  EXPECT_NEAR(seen_with_hidden_backs(down, 0), 0.8, 5e-3);
  EXPECT_NEAR(seen_with_hidden_backs(down, kSeen), 0, 5e-3);  // in the shadow of what is not seen
  EXPECT_NEAR(seen_with_hidden_backs(down, kSeen | hidden::kFromShadows), 0.4, 5e-3);
}

/// A square of 0.4 beneath one that emits; whether rays are drawn to it or find it, its hidden back sheds no light.
TEST(Hidden, BacksThatAreHiddenShedNoLight) {
  const auto below = [](uint8_t hidden_backs, bool turned, Strategy strategy) {
    Scene scene;
    Affine place = test::shift({0, 0, 1});
    if (turned) place.m[5] = place.m[10] = -1;
    SurfaceMaterial emissive = matte(0, {1});
    emissive.emission = Rgb(1);
    scene.add_instance(scene.add_mesh(test::square(1)), place, {scene.add_material(emissive)}, {}, hidden::kFromCamera);
    scene.set_hidden_backs(0, hidden_backs);
    scene.add_instance(scene.add_mesh(test::square(8)), {}, {scene.add_material(matte(0.4f, {1}))});
    scene.set_camera(test::camera_above(1));
    scene.commit(1);
    RenderOptions options = test::small_options(strategy, 256);
    return test::mean_of(test::rendered(scene, options));
  };
  for (const Strategy strategy : {Strategy::cosine, Strategy::light, Strategy::mis}) {
    const double lit = below(0, false, strategy);
    EXPECT_GT(lit, 0.05);
    EXPECT_EQ(below(hidden::kFromBounces, false, strategy), 0);  // its front is above
    EXPECT_NEAR(below(hidden::kFromBounces, true, strategy), lit, 0.02 * lit);
  }
}

TEST(Transparency, APartlyThereSurfaceCoversThatPartOfItsPixels) {
  const Scene scene = veil({0.3f});
  const auto pixels = test::rendered(scene, options_for(16384));
  EXPECT_NEAR(test::mean_of(pixels, 3), 0.3, 3e-3);  // 131072 rays: a deviation of 1.3e-3
  EXPECT_NEAR(test::mean_of(pixels), 0.3 * kAlbedo, 4e-3);
}

TEST(Transparency, LayersMultiply) {
  const auto pixels = test::rendered(veil({0.3f}, 3), options_for(16384));
  EXPECT_NEAR(test::mean_of(pixels, 3), 1 - 0.7 * 0.7 * 0.7, 4e-3);
}

/// How far the coverage of any pixel of a veil of `alpha` is from it, by 64 camera rays.
double worst_coverage(float alpha, Sequence sequence) {
  RenderOptions options = options_for(512);
  options.sequence = sequence;
  const auto pixels = test::rendered(veil({alpha}), options);
  double worst = 0;
  for (size_t i = 3; i < pixels.size(); i += 4) worst = std::max<double>(worst, std::abs(pixels[i] - alpha));
  return worst;
}

TEST(Transparency, RaysOfAPixelAreSharedOutEvenly) {
  for (const float alpha : {0.02f, 0.3f, 0.5f, 0.9f})
    EXPECT_LE(worst_coverage(alpha, Sequence::sobol), 1.0 / 64) << alpha;
  EXPECT_GT(worst_coverage(0.3f, Sequence::random), 3.0 / 64);
}

/// Also where every layer has its share exactly: those that pass the first one are any to the second.
TEST(Transparency, LayersShareRaysOutIndependently) {
  EXPECT_NEAR(test::mean_of(test::rendered(veil({0.5f}, 2), options_for(512)), 3), 0.75, 0.01);
}

TEST(Transparency, CutOutsAreExact) {
  const auto pixels = test::rendered(veil({1, 0, 0, 1}), options_for(64));
  for (size_t i = 0; i < 64; ++i) {
    const bool left = i % 8 < 4, low = i / 8 < 4;
    EXPECT_EQ(pixels[4 * i + 3], left == low ? 1 : 0) << i;
  }
}

TEST(Transparency, ControlAnOpaqueSurfaceCoversAll) {
  EXPECT_EQ(test::mean_of(test::rendered(veil({1}), options_for(64)), 3), 1);
}

/// A floor under a veil, and a camera between them that looks down: only shadow rays meet the veil.
std::vector<float> floor_pixels(float alpha, const Light* lamp, int spp) {
  Scene scene;
  add(scene, test::square(0.5f), {}, matte(kAlbedo, {1}));
  add(scene, test::square(50), test::shift({0, 0, 2}), matte(0, {alpha}));
  if (lamp != nullptr) {
    scene.add_light(*lamp);
  } else {
    scene.set_environment(Environment::constant(Rgb(1)));
  }
  scene.set_camera(Camera::look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 0.5f, 1));
  scene.commit(1);
  return test::rendered(scene, options_for(spp));
}

double floor_under_veil(float alpha, const Light* lamp) { return test::mean_of(floor_pixels(alpha, lamp, 8192)); }

TEST(Transparency, ShadowsArePartial) {
  EXPECT_NEAR(floor_under_veil(0.25f, nullptr), 0.75 * kAlbedo, 5e-3);
  Light sun;  // sharp: found by name
  const double open = kAlbedo / static_cast<double>(kPi);
  EXPECT_NEAR(floor_under_veil(0.25f, &sun), 0.75 * open, 5e-3 * open);
  EXPECT_NEAR(floor_under_veil(0, &sun), open, 1e-3 * open);
  EXPECT_EQ(floor_under_veil(1, &sun), 0);
}

/// The veil dims the sun, which nothing is drawn for: all pixels are alike.
TEST(Transparency, ShadowsOfVeilsHaveNoNoise) {
  Light sun;
  const auto pixels = floor_pixels(0.25f, &sun, 64);
  const float expected = 0.75f * kAlbedo / kPi;
  for (size_t i = 0; i < pixels.size(); i += 4) EXPECT_NEAR(pixels[i], expected, 1e-5f * expected) << i;
}

/// A wide lamp-lit floor sends its light through the veil to a lid above it.
TEST(Transparency, BouncesPass) {
  const auto lid = [](float alpha) {
    Scene scene;
    add(scene, test::square(50), test::shift({0, 0, -1}), {std::make_shared<test::Lambert>(0.0f), Rgb(1.0f), false});
    add(scene, test::square(50), test::shift({0, 0, -0.5f}), matte(0, {alpha}));
    add(scene, test::square(1), {}, {std::make_shared<test::Lambert>(1.0f), Rgb(0.0f), false});
    scene.set_camera(Camera::look_at({0, 0, -0.2f}, {0, 0, 0}, {0, 1, 0}, 0.5f, 1));
    scene.commit(1);
    return test::mean_of(test::rendered(scene, options_for(16384, 1)));
  };
  const double open = lid(0);
  EXPECT_NEAR(open, 1, 0.01);
  EXPECT_NEAR(lid(0.4f), 0.6 * open, 6e-3);
  EXPECT_EQ(lid(1), 0);
}

/// Half of it is a matte surface, the rest lets light through that gets `color`.
SurfaceMaterial pane(const Rgb& color) {
  const LayerWeight half{{{LayerFactor::Kind::share, 0.5f}}};
  return {.material = make_layered_material(
              {.reflecting = {{make_principled_material({.base_color = Rgb(0), .specular = 0}, {}, 1), half}},
               .transparent = {{color, {}, half}}}),
          .rec709_colors = false};
}

/// Camera rays, and rays that light a surface, pass colored panes in front of an environment of 1.
TEST(Transparency, ColorsMultiplyForEveryKindOfRay) {
  const Rgb color(0.8f, 0.4f, 0.1f);
  Scene seen, shaded;
  for (const float z : {0.0f, 0.5f}) add(seen, test::square(5), test::shift({0, 0, -z}), pane(color));
  seen.set_environment(Environment::constant(Rgb(1)));
  seen.set_camera(test::camera_above(1));
  seen.commit(1);
  RenderOptions options = options_for(16384);
  const auto clear = test::rendered(seen, options);
  options.transparent = false;
  const auto filled = test::rendered(seen, options);

  add(shaded, test::square(0.5f), {}, matte(kAlbedo, {1}));
  add(shaded, test::square(50), test::shift({0, 0, 2}), pane(color));
  shaded.set_environment(Environment::constant(Rgb(1)));
  shaded.set_camera(Camera::look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 0.5f, 1));
  shaded.commit(1);
  const auto shadow = test::rendered(shaded, options_for(8192));

  double passed = 0;
  for (int c = 0; c < 3; ++c) {
    const double once = 0.5 * static_cast<double>(color[c]);
    EXPECT_NEAR(test::mean_of(filled, c), once * once, 4e-3) << c;
    EXPECT_NEAR(test::mean_of(shadow, c), once * static_cast<double>(kAlbedo), 5e-3) << c;
    passed += once * once / 3;
  }
  EXPECT_NEAR(test::mean_of(clear, 3), 1 - passed, 4e-3);
  EXPECT_EQ(test::mean_of(filled, 3), 1);
}

TEST(Transparency, BouncesTakeTheColorOfWhatTheyPass) {
  Scene scene;
  add(scene, test::square(50), test::shift({0, 0, -1}), {std::make_shared<test::Lambert>(0.0f), Rgb(1.0f), false});
  add(scene, test::square(50), test::shift({0, 0, -0.5f}), pane({1, 0.5f, 0.2f}));
  add(scene, test::square(1), {}, {std::make_shared<test::Lambert>(1.0f), Rgb(0.0f), false});
  scene.set_camera(Camera::look_at({0, 0, -0.2f}, {0, 0, 0}, {0, 1, 0}, 0.5f, 1));
  scene.commit(1);
  const auto pixels = test::rendered(scene, options_for(16384, 1));
  EXPECT_NEAR(test::mean_of(pixels, 0), 0.5, 0.01);
  EXPECT_NEAR(test::mean_of(pixels, 1), 0.25, 0.01);
  EXPECT_NEAR(test::mean_of(pixels, 2), 0.1, 0.01);
}

TEST(Transparency, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = veil({0.5f}, 2);
  RenderOptions options = options_for(64, 1);
  const auto two = test::rendered(scene, options);
  options.threads = 1;
  EXPECT_EQ(test::rendered(scene, options), two);
}

/// Twice as far from the world's origin as rays are long: rounding finds triangles again.
TEST(Transparency, ATriangleIsCrossedOnce) {
  Scene scene;
  const Vec3 far(3000, -2000, 1000);
  add(scene, test::square(2), test::shift(far), matte(kAlbedo, {0.5f}));
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(Camera::look_at(far + Vec3(0.01f, 0, 0.02f), far, {0, 1, 0}, 1.0f, 1));
  scene.commit(1);
  EXPECT_NEAR(test::mean_of(test::rendered(scene, options_for(16384)), 3), 0.5, 5e-3);
}

}  // namespace
}  // namespace velour::transparency_test
