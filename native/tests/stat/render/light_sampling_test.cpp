// What the lights' samplers draw against the density of what they can be hit at: each lamp, and all light of a scene.
#include "math/sphere/random.h"
#include "render/lights/area_light.h"
#include "render/lights/lighting.h"
#include "support/sampler_proof.h"
#include "support/test_scene.h"

namespace velour::light_sampling_test {
namespace {

using test::Sampler;

struct LampCase {
  const char* name;
  Light::Type type;
  Vec2 size;
  float angle;   // of a sun
  Vec3 place;    // of the others
  bool sheared;  // axes not perpendicular
  float spread = kPi;
  bool sphere = true;
};

void PrintTo(const LampCase& c, std::ostream* out) { *out << c.name; }

Light light_of(const LampCase& c, float scale) {
  Light light;
  light.type = c.type;
  light.size = scale * c.size;
  light.angle = scale * c.angle;
  light.light_to_world = test::shift(c.place);
  light.spread = c.spread;
  light.sphere = c.sphere;
  if (c.sheared) {
    light.light_to_world.m[1] = 0.7f;
    light.light_to_world.m[9] = 0.4f;
  }
  return light;
}

/// Seen from the origin, in cells about the lamp's middle.
Sampler sampler_of(const LampCase& c, float scale) {
  const Lamp lamp(light_of(c, scale));
  const bool is_sun = c.type == Light::Type::sun;
  Sampler sampler{[lamp](const Vec2& u) { return lamp.sample(Vec3(0.0f), u); },
                  [lamp](const Vec3& w) { return static_cast<double>(lamp.hit(Vec3(0.0f), w).pdf); }};
  sampler.axis = is_sun ? Vec3(0, 0, 1) : glm::normalize(c.place);
  const float half = is_sun ? 0.5f * c.angle : 0.7f * c.size.x / glm::length(c.place);
  // Rows as fine as the lamp, so that a few of them hold all of it whatever its size.
  sampler.concentration = 0.1 / static_cast<double>(half * half);
  sampler.refinements = {3, 7};  // the density ends at the lamp's rim
  return sampler;
}

constexpr Light::Type kSun = Light::Type::sun, kSphere = Light::Type::point, kRectangle = Light::Type::rectangle,
                      kDisk = Light::Type::disk;
constexpr LampCase kLamps[] = {{"sun of 60 degrees", kSun, {}, 1.05f, {}, false},
                               {"sun of half a degree", kSun, {}, 8.7e-3f, {}, false},
                               {"sun of half a minute", kSun, {}, 1.5e-4f, {}, false},
                               {"sphere", kSphere, {0.7f, 0}, 0, {0.3f, -0.2f, 2}, false},
                               {"sphere that almost touches", kSphere, {1, 0}, 0, {0.6f, 0, 0.81f}, false},
                               {"far sphere", kSphere, {0.1f, 0}, 0, {30, -20, 200}, false},
                               {"rectangle", kRectangle, {2, 1}, 0, {0.3f, -0.2f, 2}, false},
                               {"rectangle, sheared", kRectangle, {1, 2}, 0, {0.3f, -0.2f, 2}, true},
                               {"far rectangle", kRectangle, {0.1f, 0.1f}, 0, {50, 60, 100}, false},
                               {"rectangle at grazing view", kRectangle, {1, 1}, 0, {3, 0, 0.3f}, false},
                               {"disk", kDisk, {2, 1}, 0, {0.3f, -0.2f, 2}, false},
                               {"far disk", kDisk, {0.1f, 0.1f}, 0, {50, 60, 100}, false},
                               {"disk that faces", kSphere, {0.7f, 0}, 0, {0.3f, -0.2f, 2}, false, kPi, false},
                               {"rectangle, spread", kRectangle, {2, 1}, 0, {0.3f, -0.2f, 2}, false, 0.6f}};

class LampSampling : public ::testing::TestWithParam<LampCase> {};

TEST_P(LampSampling, FollowsItsDensity) { test::expect_proven(sampler_of(GetParam(), 1), GetParam().name); }

INSTANTIATE_TEST_SUITE_P(All, LampSampling, ::testing::ValuesIn(kLamps));

TEST(LampSamplingControl, ALampFivePercentWiderIsSeen) {
  for (const LampCase& c : {kLamps[0], kLamps[1], kLamps[3], kLamps[6], kLamps[10]}) {
    const auto result = [&](float scale) {
      return test::chi_square(sampler_of(c, scale).sample, sampler_of(c, 1).pdf, test::proof_options(sampler_of(c, 1)));
    };
    EXPECT_GT(result(1).p_value, 1e-4) << c.name;
    const auto wrong = result(1.05f);
    EXPECT_TRUE(wrong.p_value < 1e-6 || !wrong.problem.empty()) << c.name;
  }
}

/// A sky, a lamp of every kind, and `more` small ones.
Scene lit(int more) {
  Scene scene;
  scene.add_mesh(test::square(2));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(0, {}, {0});
  std::vector<float> pixels(3 * 16 * 8);
  RandomStream random(3, 3, 3);
  for (float& p : pixels) p = std::pow(random.next(), 4.0f);
  scene.set_environment(Environment::image({16, 8, 3, pixels}, 1, Mat3(1.0f)));
  for (const LampCase& c : {kLamps[0], kLamps[3], kLamps[6], kLamps[11]}) {
    Light light = light_of(c, 1);
    if (c.type != kSun) light.color = Rgb(30.0f);
    scene.add_light(light);
  }
  for (int i = 0; i < more; ++i) {
    Light light;
    light.type = i % 2 == 0 ? kSphere : kRectangle;
    light.size = {0.2f, 0.3f};
    light.color = Rgb(random.next());
    light.light_to_world = test::shift({4 * random.next() - 2, 4 * random.next() - 2, 2 + random.next()});
    scene.add_light(light);
  }
  scene.commit(1);
  return scene;
}

/// All light of a scene at one place.
struct LightAtPlace {
  const Lighting& lighting;
  LightView view;
  uint8_t only = 0;

  Vec3 draw(const Vec2& u) const {
    DirectionBatch world;
    lighting.sample({&view, 1}, {&only, 1}, {&u, 1}, world);
    return world.get(0);
  }
  double density(const Vec3& w) const {
    DirectionBatch world;
    world.push(w);
    world.pad();
    RgbBatch environment;
    ScalarBatch pdf;
    std::vector<LampHit> hits;
    lighting.look_up({&view, 1}, {&only, 1}, world, environment, pdf, hits);
    return static_cast<double>(pdf.v[0]);
  }
};

TEST(LightingSampling, AllLightOfASceneFollowsItsDensity) {
  for (const int more : {0, 40}) {
    const Scene scene = lit(more);
    const Lighting lighting(scene, Progress());
    for (const LightPlace& place :
         {LightPlace{Vec3(0.0f), {0, 0, 1}}, LightPlace{Vec3(0.0f), {0.6f, 0, -0.8f}, true}}) {
      const LightAtPlace light{lighting, lighting.view(place)};
      EXPECT_GE(light.view.environment, 0.1f);
      EXPECT_GE(light.view.suns, 0.1f);
      EXPECT_GE(light.view.near, 0.1f);
      Sampler sampler{[&](const Vec2& u) { return light.draw(u); }, [&](const Vec3& w) { return light.density(w); }};
      sampler.axis = glm::normalize(kLamps[11].place);
      sampler.concentration = more > 0 ? 1 : 1e6;
      sampler.refinements = {2, 6};
      test::expect_proven(sampler, more > 0 ? "many lamps" : "all light");
      // Control: five per cent more on one side, less on the other.
      Sampler uneven = sampler;
      uneven.pdf = [&](const Vec3& w) { return light.density(w) * (w.x > 0 ? 1.05 : 0.95); };
      EXPECT_LT(test::p_value(sampler, uneven), 1e-6);
    }
  }
}

}  // namespace
}  // namespace velour::light_sampling_test
