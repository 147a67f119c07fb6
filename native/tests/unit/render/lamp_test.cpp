// Lamps: what they sample is what they measure, and their light is what physics says.
#include "render/lights/area_light.h"

#include <gtest/gtest.h>

#include <array>

#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "render/lights/lighting.h"
#include "support/test_scene.h"

namespace velour::lamp_test {
namespace {

constexpr Vec3 kUp(0, 0, 1);

/// Shines down from `height`.
Light lamp_above(Light::Type type, const Vec2& size, float height = 2) {
  Light light;
  light.type = type;
  light.size = size;
  light.light_to_world = test::shift({0.3f, -0.2f, height});
  light.angle = 0.6f;
  return light;
}

std::vector<Light> extended_lamps() {
  Light sheared = lamp_above(Light::Type::rectangle, {1, 2});
  sheared.light_to_world.m[1] = 0.7f;  // x axis and y axis not perpendicular
  sheared.light_to_world.m[9] = 0.4f;
  Light facing = lamp_above(Light::Type::spot, {0.7f, 0});
  facing.sphere = false;
  Light focused = sheared;
  focused.spread = 0.8f;
  Light leaning = lamp_above(Light::Type::disk, {2, 1});
  leaning.light_to_world.m[2] = 0.5f;  // z axis not along the normal
  leaning.light_to_world.m[6] = -0.3f;
  Light leaning_focused = leaning;
  leaning_focused.type = Light::Type::rectangle;
  leaning_focused.spread = 1.2f;
  return {leaning,
          leaning_focused,
          lamp_above(Light::Type::sun, {}),
          lamp_above(Light::Type::point, {0.7f, 0}),
          lamp_above(Light::Type::rectangle, {2, 1}),
          lamp_above(Light::Type::disk, {2, 1}),
          sheared,
          facing,
          focused};
}

/// Integrals over the lamp, seen from the origin, of functions that tell its parts apart; the first is the irradiance
/// of the plane z = 0 for radiance 1.
constexpr int kMoments = 5;
using Moments = std::array<double, kMoments>;

void add_moments(const Vec3& w, double weight, Moments& sum) {
  const double values[kMoments] = {w.z, w.z * w.x, w.z * w.y, w.z * w.x * w.x, w.z * w.x * w.y};
  for (size_t k = 0; k < kMoments; ++k) sum[k] += weight * values[k];
}

/// By uniform directions through hit() alone.
Moments moments_by_hits(const Lamp& lamp) {
  Moments sum{};
  const int n = 1000000;
  for (int i = 0; i < n; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
    const double golden = i * 0.6180339887498949;
    const Vec3 w = sample_uniform_hemisphere({u, static_cast<float>(golden - std::floor(golden))});
    if (lamp.hit(Vec3(0.0f), w).pdf > 0) add_moments(w, 2 * kPiD / n, sum);
  }
  return sum;
}

/// By sample(), weighted by its density. Every sample but one in a thousand (rims, rounding) must hit.
Moments moments_by_samples(const Lamp& lamp) {
  Moments sum{};
  RandomStream random(1, 2, 3);
  const int n = 200000;
  int missed = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3 w = lamp.sample(Vec3(0.0f), random.next2());
    const float pdf = lamp.hit(Vec3(0.0f), w).pdf;
    if (!(pdf > 0)) {
      ++missed;
    } else if (w.z > 0) {
      add_moments(w, 1.0 / (n * static_cast<double>(pdf)), sum);
    }
  }
  EXPECT_LT(missed, n / 1000);
  return sum;
}

double irradiance_by_samples(const Lamp& lamp) {
  return moments_by_samples(lamp)[0] * static_cast<double>(lamp.radiance(kUp).g);
}

TEST(Lamp, SamplesFollowTheDensityOfHits) {
  for (const Light& light : extended_lamps()) {
    const Lamp lamp(light);
    const Moments samples = moments_by_samples(lamp), hits = moments_by_hits(lamp);
    for (size_t k = 0; k < kMoments; ++k) {
      EXPECT_NEAR(samples[k], hits[k], 0.005 * hits[0]) << static_cast<int>(light.type) << " moment " << k;
    }
  }
}

TEST(Lamp, SunGivesItsIrradianceWhateverItsSize) {
  Light sun;
  for (float angle : {0.0f, 1e-3f, 0.01f, 0.5f}) {
    sun.angle = angle;
    const Lamp lamp(sun);
    if (lamp.sharp()) {
      EXPECT_EQ(angle, 0.0f);
      EXPECT_FLOAT_EQ(lamp.irradiance(Vec3(0.0f)).perpendicular.r, 1);
      EXPECT_FLOAT_EQ(lamp.irradiance(Vec3(0.0f)).direction.z, 1);
    } else {
      EXPECT_NEAR(irradiance_by_samples(lamp), 1, 2e-3) << angle;
    }
  }
}

/// Cycles does the same: a disk by the cosine to its own axis, a rectangle by the area that is seen; both over the
/// product of the sides' lengths.
TEST(Lamp, ShearedAreasShineAsInCycles) {
  for (const Light::Type type : {Light::Type::rectangle, Light::Type::disk}) {
    Light light;
    light.type = type;
    light.color = Rgb(7.0f);
    light.size = {0.01f, 0.02f};
    light.light_to_world = test::shift({0, 0, 3});
    light.light_to_world.m[2] = 0.8f;  // the z axis
    light.light_to_world.m[4] = 0.5f;  // the x axis
    const double leaning = 1 / std::sqrt(1 + 0.8 * 0.8), seen = 1 / std::sqrt(1 + 0.5 * 0.5);
    const double share = type == Light::Type::disk ? leaning : seen;
    EXPECT_NEAR(irradiance_by_samples(Lamp(light)), share * 7 / (kPiD * 9), 1e-2 * 7 / (kPiD * 9));
  }
}

TEST(Lamp, SphereLightsLikeAPointFromOutside) {
  Light light;
  light.type = Light::Type::point;
  light.light_to_world = test::shift({0, 0, 3});
  const Lamp point(light);
  ASSERT_TRUE(point.sharp());
  const float expected = 1 / (4 * kPi * 9);
  EXPECT_NEAR(point.irradiance(Vec3(0.0f)).perpendicular.r / expected, 1, 1e-5f);
  light.size.x = 1;
  EXPECT_NEAR(irradiance_by_samples(Lamp(light)) / static_cast<double>(expected), 1, 5e-3);
}

/// Narrower than float directions resolve: what sample() rounds away from the rim still counts.
TEST(Lamp, SmallBallsKeepTheirLightFromAfar) {
  Light light;
  light.type = Light::Type::point;
  light.light_to_world = test::shift({600, -700, 400});
  const double expected = static_cast<double>(Lamp(light).irradiance(Vec3(0.0f)).perpendicular.r) * 400 /
                          std::sqrt(600.0 * 600 + 700 * 700 + 400 * 400);
  for (const float radius : {1.0f, 0.01f, 3e-3f, 1e-3f, 3e-4f, 1e-4f, 1e-6f}) {
    for (const bool sphere : {true, false}) {
      light.size.x = radius;
      light.sphere = sphere;
      EXPECT_NEAR(irradiance_by_samples(Lamp(light)) / expected, 1, 1.5e-3) << radius;
    }
  }
}

/// Positions so far from the origin are a centimeter apart, but differences between them are exact.
TEST(Lamp, AreasFarFromTheOriginKeepTheirLight) {
  const auto irradiance = [](Light light, const Vec3& position) {
    light.light_to_world.m[3] = position.x + 0.25f;
    light.light_to_world.m[7] = position.y - 0.25f;
    light.light_to_world.m[11] = position.z + 2;
    const Lamp lamp(light);
    RandomStream random(4, 5, 6);
    constexpr int kSamples = 100000;
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Vec3 w = lamp.sample(position, random.next2());
      const Lamp::Sight sight = lamp.hit(position, w);
      if (sight.pdf > 0) sum += static_cast<double>(w.z / sight.pdf * lamp.radiance(w).g) / kSamples;
    }
    return sum;
  };
  for (const Light::Type type : {Light::Type::rectangle, Light::Type::disk}) {
    Light light;
    light.type = type;
    light.size = {0.1f, 0.1f};
    const double expected = irradiance(light, Vec3(0.0f));
    EXPECT_NEAR(irradiance(light, {1e5f, -5e4f, 3e4f}) / expected, 1, 1e-3);
  }
}

TEST(Lamp, PowerOfAreaLampsIsWhatTheyEmit) {
  // One side, Lambertian: pi A L.
  const Lamp rectangle(lamp_above(Light::Type::rectangle, {2, 3}));
  EXPECT_NEAR(rectangle.radiance(kUp).r * kPi * 6, 1, 1e-5f);
  const Lamp disk(lamp_above(Light::Type::disk, {2, 2}));
  EXPECT_NEAR(disk.radiance(kUp).r * kPi * kPi, 1, 1e-5f);
}

TEST(Lamp, SpreadKeepsThePowerAndEndsAtItsAngle) {
  for (const float spread : {0.2f, 1.0f, 2.0f, 3.0f}) {
    Light light = lamp_above(Light::Type::rectangle, {2, 3});
    const double even = static_cast<double>(Lamp(light).radiance(kUp).g);
    light.spread = spread;
    const Lamp lamp(light);
    const auto radiance = [&](double theta) {
      return static_cast<double>(lamp.radiance(direction(static_cast<float>(theta), 0.3f)).g);
    };
    double power = 0;  // of a square metre over pi: that of even radiance is the radiance
    const int n = 4000;
    for (int i = 0; i < n; ++i) {
      const double theta = 0.5 * kPiD * (i + 0.5) / n;
      power += radiance(theta) * std::sin(2 * theta) * 0.5 * kPiD / n;
    }
    EXPECT_NEAR(power / even, 1, 1e-3) << spread;
    EXPECT_GT(radiance(0.49 * static_cast<double>(spread)), 0) << spread;
    EXPECT_EQ(radiance(0.51 * static_cast<double>(spread)), 0) << spread;
    EXPECT_GT(radiance(0), even) << spread;
  }
}

TEST(Lamp, SpotFadesOverItsBlend) {
  Light light = lamp_above(Light::Type::spot, {0, 0});
  light.angle = 1.0f;
  light.blend = 0.5f;
  const float rim = std::cos(0.5f), inner = rim + 0.5f * (1 - rim);
  const auto share = [&](float cosine) {
    const Vec3 at = Vec3(0.3f, -0.2f, 2) - direction(std::acos(cosine), 1.0f);
    return Lamp(light).irradiance(at).perpendicular.g * 4 * kPi;
  };
  EXPECT_NEAR(share(1), 1, 1e-5f);
  EXPECT_NEAR(share(inner + 0.001f), 1, 1e-5f);
  EXPECT_NEAR(share(0.5f * (inner + rim)), 0.5f, 1e-3f);  // smooth step
  EXPECT_EQ(share(rim - 0.001f), 0);
  light.cosine = true;
  EXPECT_NEAR(share(inner + 0.001f), inner + 0.001f, 1e-5f);
}

TEST(Lamp, SpotsOfScaledObjectsHaveEllipticCones) {
  Light light = lamp_above(Light::Type::spot, {0, 0});
  light.angle = 1.0f;
  light.blend = 0.5f;
  light.light_to_world = {{0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 2}};  // x points along the world's y
  const auto share = [&](const Vec3& along) {
    return Lamp(light).irradiance(Vec3(0, 0, 2) + glm::normalize(along)).perpendicular.g * 4 * kPi;
  };
  float circular[2];
  for (const int axis : {0, 1}) circular[axis] = share({axis == 0 ? 0.45f : 0, axis == 1 ? 0.45f : 0, -1});
  ASSERT_GT(circular[0], 0.1f);
  ASSERT_LT(circular[0], 0.9f);
  light.cone_scale = {2, 0.5f};
  EXPECT_NEAR(share({0, 0.9f, -1}), circular[0], 1e-5f);
  EXPECT_NEAR(share({0.225f, 0, -1}), circular[1], 1e-5f);
  EXPECT_EQ(share({0.45f, 0, -1}), 0);
  EXPECT_NEAR(share({0, 0, -1}), 1, 1e-5f);
}

TEST(Lamp, DiskThatFacesIsSeenUnderItsTangent) {
  Light light;
  light.type = Light::Type::point;
  light.light_to_world = test::shift({0, 0, 3});
  light.size.x = 1;
  light.sphere = false;
  const Lamp disk(light);
  const auto meets = [&](float tangent) { return disk.hit(Vec3(0.0f), glm::normalize(Vec3(tangent, 0, 1))); };
  EXPECT_EQ(meets(1.01f / 3).pdf, 0);
  ASSERT_GT(meets(0.99f / 3).pdf, 0);
  EXPECT_NEAR(meets(0.3f).distance, 3 * std::sqrt(1.09f), 1e-4f);
  // The disk itself: radiance x pi sin^2 of the cone.
  const double expected = 1 / (4 * kPiD * 10);
  EXPECT_NEAR(irradiance_by_samples(disk) / expected, 1, 5e-3);
}

TEST(Lamp, DarkSideInsideAndDegenerate) {
  const Lamp rectangle(lamp_above(Light::Type::rectangle, {2, 3}));
  EXPECT_EQ(rectangle.sample({0, 0, 4}, {0.5f, 0.5f}), Vec3(0.0f));
  EXPECT_EQ(rectangle.hit({0.3f, -0.2f, 4}, {0, 0, -1}).pdf, 0);
  const Lamp sphere(lamp_above(Light::Type::point, {1, 0}));
  EXPECT_EQ(sphere.sample({0.3f, -0.2f, 2.5f}, {0.5f, 0.5f}), Vec3(0.0f));
  EXPECT_TRUE(Lamp(lamp_above(Light::Type::rectangle, {0, 3})).black());
  Light off = lamp_above(Light::Type::point, {1, 0});
  off.color = Rgb(0.0f);
  EXPECT_TRUE(Lamp(off).black());
}

/// Points side by side above the plane, one below it, and a sun.
TEST(Lighting, DeltaLightsAreChosenByTheirIrradiance) {
  Scene scene;
  Light light;
  light.type = Light::Type::point;
  light.light_to_world = test::shift({0, 0, 3});
  for (float power : {1.0f, 0.0f, 3.0f, 6.0f}) {
    light.color = Rgb(power);
    scene.add_light(light);
  }
  light.light_to_world = test::shift({0, 0, -3});
  scene.add_light(light);
  scene.commit(1);
  const LightPlace floor{Vec3(0.0f), {0, 0, 1}};
  // By lamp, from numbers side by side; each says its probability.
  const auto shares = [&](const Lighting& lighting) {
    const LightView view = lighting.sharp_view(floor);
    std::vector<float> share(lighting.sharp().size());
    constexpr int kNumbers = 4096;
    for (int i = 0; i < kNumbers; ++i) {
      float probability;
      const size_t lamp = lighting.choose_sharp(view, (static_cast<float>(i) + 0.5f) / kNumbers, probability);
      share[lamp] += 1.0f / kNumbers;
      if (lamp < 3) {
        const float brought = lighting.sharp()[lamp].irradiance(floor.position).perpendicular.r;
        EXPECT_NEAR(brought / probability, 10 / (36 * kPi), 2e-3f);
      }
    }
    return share;
  };
  {
    const Lighting lighting(scene, Progress());
    ASSERT_EQ(lighting.sharp().size(), 4u);  // the dark one is gone
    EXPECT_FALSE(lighting.has_extended());
    const auto share = shares(lighting);
    EXPECT_NEAR(share[0], 0.1f, 2e-3f);
    EXPECT_NEAR(share[1], 0.3f, 2e-3f);
    EXPECT_NEAR(share[2], 0.6f, 2e-3f);
    EXPECT_LT(share[3], 2e-3f);
  }
  Light sun;
  sun.color = Rgb(10 / (36 * kPi));  // as much as the points together
  scene.add_light(sun);
  scene.commit(1);
  const Lighting lighting(scene, Progress());
  const LightView view = lighting.sharp_view(floor);
  EXPECT_NEAR(view.suns, 0.5f, 1e-3f);
  float probability;
  EXPECT_EQ(lighting.choose_sharp(view, 0.2f, probability), 0u);  // suns come first
  EXPECT_NEAR(probability, 0.5f, 1e-3f);
}

/// What a light brings to a plane is what it is chosen by, at least three tenths of an equal part.
TEST(Lighting, SkyAndLampAreChosenByWhatTheyBringToThePlane) {
  Scene scene;
  scene.add_mesh(test::square(100));  // its size is of no account
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  scene.set_environment(Environment::constant(Rgb(1 / kPi)));
  Light lamp;
  lamp.type = Light::Type::disk;
  lamp.size = {0.1f, 0.1f};
  lamp.color = Rgb(12 * kPi);  // 3 W/m2 from two metres
  lamp.light_to_world = test::shift({0, 0, 2});
  scene.add_light(lamp);
  scene.commit(1);
  const Lighting lighting(scene, Progress());
  const auto share = [&](const Vec3& position, const Vec3& normal) {
    return lighting.view({position, normal}).environment;
  };
  EXPECT_NEAR(share(Vec3(0), {0, 0, 1}), 0.15f + 0.7f * 0.25f, 0.01f);
  EXPECT_NEAR(share({100, 0, 0}, {0, 0, 1}), 0.85f, 0.01f);
  EXPECT_NEAR(share(Vec3(0), {0, 0, -1}), 0.85f, 0.01f);
}

/// Estimates of such light exceed floats.
TEST(Lighting, HugeRadiancesBesideASunAreSampled) {
  Light sun;
  sun.angle = 0.01f;
  for (const float radiance : {1e30f, 1e38f}) {
    Scene scene;
    scene.set_environment(Environment::constant(Rgb(radiance)));
    scene.add_light(sun);
    scene.commit(1);
    const Lighting lighting(scene, Progress());
    const LightView view = lighting.view({Vec3(0.0f), kUp});
    const uint8_t only = 0;
    for (const float x : {0.0f, 0.5f, 1 - 0x1p-24f}) {
      const Vec2 u(x, 0.5f);
      DirectionBatch world;
      lighting.sample({&view, 1}, {&only, 1}, {&u, 1}, world);
      EXPECT_NEAR(glm::length(world.get(0)), 1, 1e-5f) << radiance << " at " << x;
    }
  }
}

TEST(Lamp, ASunScaledToNothingIsBlack) {
  Light sun;
  std::fill(std::begin(sun.light_to_world.m), std::end(sun.light_to_world.m), 0.0f);
  Scene scene;
  scene.add_light(sun);
  scene.commit(1);
  EXPECT_EQ(Lighting(scene, Progress()).view({Vec3(0.0f), kUp}).suns, 0.0f);
}

}  // namespace
}  // namespace velour::lamp_test
