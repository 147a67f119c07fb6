// Blurred pictures against closed forms: coverage, light of what moves, and the bits of what does not.
#include <gtest/gtest.h>

#include <cmath>

#include "support/renders.h"

namespace velour::motion_blur_test {
namespace {

using test::shift;
using test::ZTests;

constexpr int kSide = 16;  // pixels, which span 4 m
constexpr int kRenders = 8;

Camera camera_from_above() {
  Camera camera = Camera::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1, 1);
  camera.type = Camera::Type::orthographic;
  for (int i = 0; i < 4; ++i) camera.window[i] = i % 2 == 0 ? -2.0f : 2.0f;
  return camera;
}

RenderOptions options_of(int spp) {
  RenderOptions options = test::small_options(Strategy::cosine, spp);
  options.width = options.height = kSide;
  options.split = 1;
  return options;
}

/// Scene with black things before a white sky.
Scene before_sky(Mesh mesh) {
  Scene scene;
  scene.add_mesh(std::move(mesh));
  scene.add_material({std::make_shared<test::Lambert>(0.0f), Rgb(0.0f), false});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  return scene;
}

/// Share of the time in which the point is not covered, of a pixel by its place.
using Clear = double (*)(double x, double y);

double mean_over(int pixel_x, int pixel_y, Clear clear) {
  constexpr int kParts = 32;
  double sum = 0;
  for (int i = 0; i < kParts * kParts; ++i) {
    const double x = pixel_x + (i % kParts + 0.5) / kParts, y = pixel_y + (i / kParts + 0.5) / kParts;
    sum += clear(4 * x / kSide - 2, 4 * y / kSide - 2);
  }
  return sum / (kParts * kParts);
}

/// Compares each pixel.
void compare_pixels(const Scene& scene, Clear clear, ZTests& tests) {
  std::vector<test::RunningMean> means(kSide * kSide);
  RenderOptions options = options_of(128);
  for (int i = 0; i < kRenders; ++i) {
    options.seed = static_cast<uint64_t>(i);
    const std::vector<float> pixels = test::rendered(scene, options);
    for (size_t p = 0; p < means.size(); ++p) means[p].add(static_cast<double>(pixels[4 * p]));
  }
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      test::Estimate found = means[static_cast<size_t>(y * kSide + x)].estimate();
      found.error = std::max(found.error, 1e-4);  // the quadrature of the closed form, and polygons
      tests.add(std::to_string(x) + " " + std::to_string(y), found, {mean_over(x, y, clear), 1e-3});
    }
  }
}

double overlap(double low, double high) { return std::max(0.0, std::min(high, 1.0) - std::max(low, -1.0)); }

/// A ball of radius 0.5 whose center moves from x = -1 to 1.
double ball_clear(double x, double y) {
  const double half = std::sqrt(std::max(0.0, 0.25 - y * y));
  return 1 - overlap(x - half, x + half) / 2;
}

Scene moving_ball(std::vector<float> shutter) {
  Scene scene = before_sky(test::sphere(64));
  const std::vector<Affine> steps = {shift({-1, 0, 0}, Vec3(0.5f)), shift({1, 0, 0}, Vec3(0.5f))};
  scene.add_moving_instance(0, steps, {0});
  Camera camera = camera_from_above();
  camera.shutter.emplace(std::move(shutter));
  scene.set_camera(camera);
  return scene;
}

TEST(MotionBlur, AMovingBallCoversItsShareOfTheTime) {
  Scene scene = moving_ball({1.0f});
  scene.commit(1);
  ZTests tests;
  compare_pixels(scene, ball_clear, tests);
  EXPECT_TRUE(tests.agree());
  ZTests control;  // a shutter that opens late
  Scene late = moving_ball({0, 1});
  late.commit(1);
  compare_pixels(late, ball_clear, control);
  EXPECT_TRUE(control.differ());
}

TEST(MotionBlur, ACameraThatMovesBackBlursAlike) {
  Scene scene = before_sky(test::sphere(64));
  scene.add_instance(0, shift({0, 0, 0}, Vec3(0.5f)), {0});
  Camera camera = camera_from_above();
  Affine from = camera.camera_to_world, to = from;
  from.m[3] = 1;
  to.m[3] = -1;
  camera.steps = {from, to};
  camera.shutter.emplace();
  scene.set_camera(camera);
  scene.commit(1);
  ZTests tests;
  compare_pixels(scene, ball_clear, tests);
  EXPECT_TRUE(tests.agree());
}

/// A sector: the ray (1, 0) of a square on y > 0 turns by a right angle from x to y. What it has passed is covered.
double turning_clear(double x, double y) {
  if (x * x + y * y > 1.5 * 1.5) return -1;  // not compared
  if (x < 0 && y < 0) return 1;
  const double turn = std::atan2(y, x) / (0.5 * std::acos(-1.0));  // 0 along x, 1 along y
  // The square covers turn in [t, t + 1] of right angles, for t from 0 to 1.
  if (turn >= 0 && turn <= 1) return 1 - turn;
  return turn > 1 && turn <= 2 ? turn - 1 : 1.0;
}

TEST(MotionBlur, ATurningSquareCoversTheAngles) {
  Scene scene = before_sky(Mesh({.positions = std::vector<Vec3>{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}},
                                 .triangles = std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}}));
  const Affine turned({0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0});
  scene.add_moving_instance(0, std::vector<Affine>{Affine{}, turned}, {0});
  Camera camera = camera_from_above();
  camera.shutter.emplace();
  scene.set_camera(camera);
  scene.commit(1);
  ZTests tests, control;
  std::vector<test::RunningMean> means(kSide * kSide);
  RenderOptions options = options_of(128);
  for (int i = 0; i < kRenders; ++i) {
    options.seed = static_cast<uint64_t>(i);
    const std::vector<float> pixels = test::rendered(scene, options);
    for (size_t p = 0; p < means.size(); ++p) means[p].add(static_cast<double>(pixels[4 * p]));
  }
  for (int y = 2; y < kSide - 2; ++y) {
    for (int x = 2; x < kSide - 2; ++x) {
      const double cx = 4 * (x + 0.5) / kSide - 2, cy = 4 * (y + 0.5) / kSide - 2;
      if (cx * cx + cy * cy > 1.2 * 1.2 || cx * cx + cy * cy < 0.5 * 0.5) continue;
      test::Estimate found = means[static_cast<size_t>(y * kSide + x)].estimate();
      const std::string name = std::to_string(x) + " " + std::to_string(y);
      // Chords are up to a thousandth inside the arc.
      tests.add(name, found, {mean_over(x, y, turning_clear), 1e-3});
      control.add(name, found, {mean_over(y, x, turning_clear), 1e-3});
    }
  }
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

/// A square of side 4 that shrinks to a point: corners move to the center.
double shrinking_clear(double x, double y) { return std::max(std::abs(x), std::abs(y)) / 2; }

TEST(MotionBlur, ADeformingSquareCoversWhatIsLeftOfIt) {
  const std::vector<Vec3> p = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  std::vector<Vec3> shapes = p, middle;
  for (const Vec3& corner : p) {
    shapes.push_back(0.001f * corner);
    middle.push_back(0.5f * corner);
  }
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  Scene scene = before_sky(Mesh({.positions = middle, .triangles = t, .steps = 2, .moved_positions = shapes}));
  scene.add_instance(0, {}, {0});
  Camera camera = camera_from_above();
  camera.shutter.emplace();
  scene.set_camera(camera);
  scene.commit(1);
  ZTests tests;
  compare_pixels(scene, shrinking_clear, tests);
  EXPECT_TRUE(tests.agree());
}

TEST(MotionBlur, ShadowsMoveWithWhatCastsThem) {
  Scene scene = moving_ball({1.0f});
  scene.clear_instances();
  scene.set_environment(Environment::constant(Rgb(0.0f)));
  const uint32_t ground = scene.add_mesh(test::square(4));
  const uint32_t gray = scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(ground, shift({0, 0, -1}), {gray});
  const std::vector<Affine> steps = {shift({-1, 0, 0}, Vec3(0.5f)), shift({1, 0, 0}, Vec3(0.5f))};
  scene.add_moving_instance(0, steps, {0}, {}, hidden::kFromCamera);
  Light sun;  // straight down
  sun.color = Rgb(2 * kPi);
  scene.add_light(sun);
  scene.commit(1);
  ZTests tests;
  compare_pixels(scene, ball_clear, tests);
  EXPECT_TRUE(tests.agree());
}

/// Light of a square that moves, on a plane: sampled as a light and found by directions of the surface.
TEST(MotionBlur, StrategiesAgreeOnTheLightOfWhatMoves) {
  ZTests tests, control;
  const auto lit = [](Strategy strategy, float way) {
    Scene scene;
    scene.add_mesh(test::square(3));
    scene.add_mesh(test::square(0.4f));
    scene.add_material({std::make_shared<test::Lambert>(0.7f), Rgb(0.0f), false});
    scene.add_material({std::make_shared<test::Lambert>(0.0f), Rgb(4.0f), false});
    scene.add_instance(0, {}, {0});
    scene.add_moving_instance(1, std::vector<Affine>{shift({-way, 0, 1}), shift({way, 0, 1})}, {1}, {},
                              hidden::kFromCamera);
    Camera camera = camera_from_above();
    camera.shutter.emplace();
    scene.set_camera(camera);
    scene.commit(1);
    return test::independent_renders(
        scene,
        [&] {
          RenderOptions options = test::small_options(strategy, 256);
          options.split = 1;
          return options;
        }(),
        kRenders, 1, 2);
  };
  const auto expected = lit(Strategy::mis, 1);
  compare("cosine", lit(Strategy::cosine, 1), expected, tests);
  compare("light", lit(Strategy::light, 1), expected, tests);
  compare("still", lit(Strategy::mis, 0), expected, control);
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(control.differ());
}

TEST(MotionBlur, AnOpenShutterChangesNoBitOfAStillScene) {
  const auto picture = [](bool open, bool moves, int threads) {
    Scene scene = before_sky(test::sphere(16));
    const std::vector<Affine> steps = {shift({-0.5f, 0, 0}), shift({0, 0, 0}), shift({0.5f, 0, 0})};
    scene.add_moving_instance(0, moves ? std::span(steps) : std::span(steps).subspan(1, 1), {0});
    Camera camera = camera_from_above();
    if (open) camera.shutter.emplace();
    scene.set_camera(camera);
    scene.commit(1);
    RenderOptions options = options_of(16);
    options.threads = threads;
    return test::rendered(scene, options);
  };
  const auto sharp = picture(false, false, 1);
  EXPECT_EQ(picture(true, false, 1), sharp);
  EXPECT_EQ(picture(false, true, 1), sharp);  // only the pass "Vector" shows the motion
  EXPECT_NE(picture(true, true, 1), sharp);
  EXPECT_EQ(picture(true, true, 3), picture(true, true, 1));
}

TEST(MotionBlur, VectorIsTheMotionInPixels) {
  Scene scene = before_sky(test::square(3));
  const std::vector<Affine> steps = {shift({-1, 0, 0}), shift({0, 0, 0}), shift({0, 0.5f, 0})};
  scene.add_moving_instance(0, steps, {0});
  scene.set_camera(camera_from_above());
  scene.commit(1);
  PassOptions passes;
  passes.asked = pass::kVector;
  const RenderOptions options = options_of(4);
  Film film(options.window(), passes);
  Progress progress;
  render(scene, options, film, progress);
  std::vector<float> vector(kSide * kSide * 4);
  film.read_pass("Vector", vector);
  const float expected[] = {-kSide / 4.0f, 0, 0, -kSide / 8.0f};
  for (size_t i = 0; i < vector.size(); ++i) EXPECT_NEAR(vector[i], expected[i % 4], 1e-4f);
}

}  // namespace
}  // namespace velour::motion_blur_test
