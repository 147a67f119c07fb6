// Surfaces that emit, as lights: closed forms, the sampler against its density, and renders that draw rays to them
// against renders that find them by what surfaces reflect.
#include <gtest/gtest.h>

#include <array>

#include "material/shader_layers.h"
#include "render/lights/lighting.h"
#include "render/tile_renderer.h"
#include "support/level.h"
#include "support/polygon_irradiance.h"
#include "support/proof_materials.h"
#include "support/proof_strategies.h"
#include "support/renders.h"
#include "support/sampler_proof.h"
#include "support/textured_scenes.h"

namespace velour::emissive_meshes_test {
namespace {

using test::NamedStrategy;

constexpr float kAlbedo = 0.6f, kRadiance = 3;

SurfaceMaterial matte(float albedo) { return {std::make_shared<test::Lambert>(albedo), Rgb(0.0f), false}; }
SurfaceMaterial emissive(float radiance) { return {std::make_shared<test::Lambert>(0.0f), Rgb(radiance), false}; }

/// What `half` of a square's sides are placed by, and where.
Affine placed(const std::array<float, 12>& m) {
  Affine map;
  std::copy(m.begin(), m.end(), map.m);
  return map;
}

constexpr std::array<float, 12> kPlaces[] = {
    {1, 0, 0, 0.7f, 0, 0.5f, 0, 0.2f, 0, 0, 1, 1.5f},             // flat, faces up: its back lights the floor
    {1, 0, 0, 0.7f, 0, -0.5f, 0, 0.2f, 0, 0, 1, 1.5f},            // mirrored
    {1, 0.6f, 0, -0.3f, 0, 0.7f, 0, 0.4f, 0.3f, -0.4f, 1, 1.6f},  // sheared, leaning
    {0.05f, 0, 0, 0.1f, 0, 0.05f, 0, 0.05f, 0, 0, 1, 0.4f},       // small
    {30, 0, 0, 5, 0, 30, 0, -3, 0, 0, 1, 2},                      // nearly all of the sky
};

/// A floor with the camera above it, which does not see the square that emits.
Scene floor_under(const Affine& place) {
  Scene scene;
  scene.add_instance(scene.add_mesh(test::square(100)), {}, {scene.add_material(matte(kAlbedo))});
  scene.add_instance(scene.add_mesh(test::square(1)), place, {scene.add_material(emissive(kRadiance))}, {},
                     hidden::kFromCamera);
  scene.set_camera(test::camera_above(0.001f));
  scene.commit(1);
  return scene;
}

double closed_form(const Affine& place) {
  std::array<Vec3d, 4> corners;
  constexpr float kSigns[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (size_t i = 0; i < 4; ++i) corners[i] = Vec3d(place.point({kSigns[i][0], kSigns[i][1], 0}));
  return static_cast<double>(kAlbedo * kRadiance) / kPiD * test::polygon_irradiance(corners);
}

TEST(EmissiveMeshes, AQuadLightsAFloorInClosedForm) {
  test::ZTests tests, control;
  const int seeds = test::long_tests() ? 12 : 8;  // more comparisons: each must know its noise better
  for (size_t k = 0; k < std::size(kPlaces); ++k) {
    const Affine place = placed(kPlaces[k]);
    const Scene scene = floor_under(place);
    for (const NamedStrategy& s : test::all_strategies()) {
      const bool blind = s.strategy != Strategy::light && !is_mixed(s.strategy);
      if (blind && k > 0 && !test::long_tests()) continue;  // what surfaces reflect does not know of lights
      RenderOptions options = test::small_options(s.strategy, blind ? 384 : 96);
      options.heuristic = s.heuristic;
      options.light_share = s.light_share;
      const std::string name = s.name + " place " + std::to_string(k);
      const test::Estimate found = test::independent_renders(scene, options, seeds, 1).whole();
      tests.add(name, found, test::closed_form(closed_form(place), 3e-4));
      if (s.name == "mis") control.add(name, found, test::closed_form(1.02 * closed_form(place), 3e-4));
      EXPECT_LT(tests.smallest_bias(name), is_mixed(s.strategy) ? 0.03 : 0.3) << name;
    }
  }
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

/// Squares whose pictures emit, one a mixture, one scaled and sheared, under a dim sky and beside a lamp.
Scene gallery(bool drawn_to, float light = 1) {
  Scene scene;
  scene.add_instance(scene.add_mesh(test::square(4)), {}, {scene.add_material(matte(0.7f))});
  std::vector<Rgb> texels;
  for (int i = 0; i < 16; ++i) texels.push_back(i % 5 == 1 ? light * Rgb(9, 6, 2) : Rgb(0.0f));
  const auto picture =
      std::make_shared<const Texture<Rgb>>(4, 4, texels, TextureOptions{.filter = TextureFilter::closest});
  const LayerWeight half{{{LayerFactor::Kind::share, 0.5f}}};
  ShaderLayers layers;
  layers.reflecting.emplace_back(std::make_shared<test::Lambert>(0.5f), half);
  layers.transparent.emplace_back(Rgb(1, 0.8f, 0.4f), TextureSlot<Rgb>{}, half);
  layers.emissive.emplace_back(Rgb(1.0f), TextureSlot<Rgb>{picture}, half);
  const auto mixed = make_layered_material(std::move(layers));
  SurfaceMaterial textured{.material = mixed, .rec709_colors = false, .drawn_to = drawn_to};
  SurfaceMaterial plain = emissive(2 * light);
  plain.drawn_to = drawn_to;
  const uint32_t shown = scene.add_mesh(test::repeating_square(0.8f, 1)), ball = scene.add_mesh(test::sphere(8)),
                 pictured = scene.add_material(textured), even = scene.add_material(plain);
  scene.add_instance(shown, test::shift({-1, 0, 1.2f}), {pictured}, {TextureMap{Mat2(2.0f), Vec2(0.3f)}});
  scene.add_instance(shown, placed(kPlaces[2]), {pictured});
  for (int i = 0; i < 3; ++i) {
    scene.add_instance(ball, test::shift({1.2f - static_cast<float>(i), -1.5f, 0.5f}, {0.1f, 0.2f, 0.15f}), {even});
  }
  scene.set_environment(Environment::constant(light * Rgb(0.05f)));
  Light lamp;
  lamp.type = Light::Type::rectangle;
  lamp.size = {0.5f, 0.5f};
  lamp.color = Rgb(6 * light);
  lamp.light_to_world = test::shift({1, 1, 2.5f});
  scene.add_light(lamp);
  scene.set_camera(Camera::look_at({0, -6, 4}, {0, 0, 0.4f}, {0, 0, 1}, 0.6f, 1));
  scene.commit(2);
  return scene;
}

test::PictureMeans pictures(const Scene& scene, const NamedStrategy& s, int spp, uint64_t seed, int bounces) {
  RenderOptions options = test::small_options(s.strategy, spp);
  options.heuristic = s.heuristic;
  options.light_share = s.light_share;
  options.bounces = bounces;
  return test::independent_renders(scene, options, 16, seed);
}

/// The reference draws no rays: it is what was rendered before there were any, but for the bounce that it counts less.
TEST(EmissiveMeshes, DrawnRaysChangeNothingButNoise) {
  test::ZTests tests, control;
  for (const int bounces : {0, 1}) {
    if (bounces == 0 && !test::long_tests()) continue;  // a bounce has direct light, too
    const Scene drawn = gallery(true);
    const auto expected = pictures(gallery(false), {"cosine", Strategy::cosine}, 10240, 1'000'000, bounces);
    for (const NamedStrategy& s : test::all_strategies()) {
      const bool blind = s.strategy != Strategy::light && !is_mixed(s.strategy);
      compare(s.name + " " + std::to_string(bounces), pictures(drawn, s, blind ? 1280 : 640, 1, bounces), expected,
              tests);
    }
    compare("brighter", pictures(gallery(true, 1.05f), {"mis", Strategy::mis}, 640, 1, bounces), expected, control);
    EXPECT_LT(tests.smallest_bias("mis " + std::to_string(bounces) + " whole"), 0.05);
  }
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

/// Without directions from the surface side, what no rays are drawn to is left to bounces.
TEST(EmissiveMeshes, WhatNoRaysAreDrawnToIsFoundByBouncesAlone) {
  Scene scene;
  const uint32_t floor = scene.add_material(matte(kAlbedo)), ceiling = scene.add_material(emissive(kRadiance));
  scene.add_instance(scene.add_mesh(test::square(100)), {}, {floor});
  scene.add_instance(scene.add_mesh(test::square(1000)), test::shift({0, 0, 2}), {ceiling}, {}, hidden::kFromCamera);
  scene.set_camera(test::camera_above(0.001f));
  scene.set_drawn_to(ceiling, false);
  scene.commit(1);
  RenderOptions options = test::small_options(Strategy::light, 1024);
  EXPECT_EQ(test::mean_of(test::rendered(scene, options)), 0);
  options.bounces = 1;
  const double expected = static_cast<double>(kAlbedo * kRadiance);
  EXPECT_NEAR(test::mean_of(test::rendered(scene, options)), expected, 0.01 * expected);
  options.strategy = Strategy::mis;
  options.bounces = 0;
  EXPECT_NEAR(test::mean_of(test::rendered(scene, options)), expected, 0.03 * expected);
}

/// Mean of a render whose first vertices mix their directions as given, as after a pilot.
double mean_mixed(const Scene& scene, const RenderOptions& options, const Mixing& mixing) {
  Progress progress;
  RenderContext context(scene, options, progress);
  context.mixing.assign(scene.materials().size(), mixing);
  Film film(options.width, options.height);
  TileRenderer(context).render(film.window(), 0, context.camera_rays(), film, nullptr, progress);
  std::vector<float> pixels(static_cast<size_t>(4 * film.width() * film.height()));
  film.read_pass("Combined", pixels);
  return test::mean_of(pixels);
}

/// A vertex may add an emission with its own directions or leave it to its continuation, but not both: under a share of
/// 1, the strategy samples nothing from the surface, yet the directions of a pilot or of products meet emitters.
TEST(EmissiveMeshes, EmittersThatAreNotLightSampledCountOnceWhateverMeetsThem) {
  Scene scene;
  const uint32_t floor = scene.add_material({test::highlight_material(4), Rgb(0.0f), false}),
                 ceiling = scene.add_material(emissive(kRadiance));
  scene.add_instance(scene.add_mesh(test::square(100)), {}, {floor});
  scene.add_instance(scene.add_mesh(test::square(1)), test::shift({0, 0, 2}), {ceiling}, {}, hidden::kFromCamera);
  std::vector<float> sky(3 * 32 * 16, 0.05f);
  std::fill_n(sky.begin(), sky.size() / 4, 0.5f);
  scene.set_environment(Environment::image({32, 16, 3, sky}, 1, Mat3(1.0f)));
  scene.set_camera(test::camera_above(0.001f));
  scene.set_drawn_to(ceiling, false);
  scene.commit(1);
  RenderOptions options = test::small_options(Strategy::mis, 4096);
  options.bounces = 1;
  const double expected = test::mean_of(test::rendered(scene, options));
  options.light_share = 1;
  EXPECT_NEAR(test::mean_of(test::rendered(scene, options)), expected, 0.02 * expected);
  EXPECT_NEAR(mean_mixed(scene, options, {false, 0.75f}), expected, 0.02 * expected);
  options.strategy = Strategy::product;
  EXPECT_NEAR(test::mean_of(test::rendered(scene, options)), expected, 0.02 * expected);
  options.light_share = 0.5f;
  options.bounces = 0;  // nothing is left to bounces
  EXPECT_NEAR(test::mean_of(test::rendered(scene, options)), expected, 0.02 * expected);
}

/// Three floors of light above each other: each hides those above it, unless shadow rays or all bounces pass it.
TEST(EmissiveMeshes, ThoseInFrontHideThoseBehind) {
  const auto seen = [](uint8_t first_hidden, Strategy strategy) {
    Scene scene;
    scene.add_instance(scene.add_mesh(test::square(1)), {}, {scene.add_material(matte(kAlbedo))});
    const uint32_t wide = scene.add_mesh(test::square(1000));
    for (int i = 0; i < 3; ++i) {
      const uint8_t hidden_from = hidden::kFromCamera | (i == 0 ? first_hidden : uint8_t{0});
      scene.add_instance(wide, test::shift({0, 0, 1 + static_cast<float>(i)}),
                         {scene.add_material(emissive(std::pow(10.0f, static_cast<float>(i))))}, {}, hidden_from);
    }
    scene.set_camera(test::camera_above(0.001f));
    scene.commit(1);
    return test::mean_of(test::rendered(scene, test::small_options(strategy, 4096))) / static_cast<double>(kAlbedo);
  };
  for (const Strategy strategy : {Strategy::cosine, Strategy::mis}) {
    EXPECT_NEAR(seen(0, strategy), 1, 0.02);
    EXPECT_NEAR(seen(hidden::kFromShadows, strategy), 11, 0.3);
    EXPECT_NEAR(seen(hidden::kFromBounces, strategy), 0, 1e-9);  // no light, and yet a shadow
    EXPECT_NEAR(seen(hidden::kFromBounces | hidden::kFromShadows, strategy), 10, 0.3);
  }
}

TEST(EmissiveMeshes, PicturesAreTheSameForAnyNumberOfThreads) {
  const Scene scene = gallery(true);
  RenderOptions options = test::small_options(Strategy::mis, 64);
  options.bounces = 2;
  const auto two = test::rendered(scene, options);
  options.threads = 1;
  EXPECT_EQ(test::rendered(scene, options), two);
}

/// Rays that meet it go on.
class Veil : public test::Lambert {
 public:
  Veil() : Lambert(0.5f) {}
  bool opaque() const override { return false; }
  float alpha(const SurfaceSite& /*site*/) const override { return 0.5f; }
};

/// Thin, so that rays to those behind pass those in front, and the density of a direction is a sum.
Scene thin_lights() {
  Scene scene;
  const auto thin = [&](float radiance) {
    return scene.add_material({std::make_shared<Veil>(), Rgb(radiance), false});
  };
  const uint32_t dim = thin(1), bright = thin(5), quad = scene.add_mesh(test::square(1)),
                 box = scene.add_mesh(test::sphere(2));
  scene.add_instance(quad, test::shift({0.4f, -0.3f, 2}), {dim});
  scene.add_instance(quad, placed(kPlaces[2]), {bright});
  scene.add_instance(box, test::shift({-2, 1, 1}, {0.6f, 1.2f, 1}), {bright});
  scene.add_instance(box, test::shift({1, 2, -1}), {dim});
  scene.commit(1);
  return scene;
}

TEST(EmissiveMeshes, RaysAreDrawnByTheirDensity) {
  const Scene scene = thin_lights();
  const Lighting lighting(scene, Progress());
  const Vec3 origin(0.0f);
  const LightView view = lighting.view({origin, {0, 0.6f, 0.8f}});
  const uint8_t only = 0;
  const auto draw = [&](const Vec2& u) {
    DirectionBatch world;
    lighting.sample({&view, 1}, {&only, 1}, {&u, 1}, world);
    return world.get(0);
  };
  const auto density = [&](const Vec3& w) {
    const Ray ray{origin, 0, w};
    std::vector<EmissiveHit> found;
    lighting.emissive().meet({&ray, 1}, found);
    double sum = 0;
    for (const EmissiveHit& f : found) sum += static_cast<double>(lighting.emissive_pdf(view, w, f.hit));
    return sum;
  };
  test::Sampler sampler{draw, density};
  sampler.refinements = {4, 9};
  test::expect_proven(sampler, "surfaces");
  test::Sampler uneven = sampler;
  uneven.pdf = [&](const Vec3& w) { return density(w) * (w.x > 0 ? 1.05 : 0.95); };
  EXPECT_LT(test::p_value(sampler, uneven), 1e-6);
}

}  // namespace
}  // namespace velour::emissive_meshes_test
