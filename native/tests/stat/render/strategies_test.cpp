// Every strategy, with every combination and sequence, has the same expectation in five scenes.
//
// A comparison is the mean of many independent renders against that of more renders by `mis`, block by block and over
// the picture, judged as one list. Each must be able to see a bias of five per cent of the picture's mean, or it would
// prove nothing; controls show that it does.
#include <map>

#include "support/level.h"
#include "support/proof_scenes.h"
#include "support/proof_strategies.h"
#include "support/renders.h"
#include "support/significance.h"
#include "support/test_data.h"

namespace velour::strategies_test {
namespace {

using test::NamedStrategy;
using test::PictureMeans;
using test::ProofScene;

/// Smallest bias that a comparison must see.
constexpr double kPower = 0.05;

/// Samples in multiples of 590,000 directions, by how a strategy finds light: enough for kPower and no more.
struct Samples {
  double blind;   // uniform, cosine
  double lobes;   // table, srbf, ggx
  double lights;  // light
  double mixed;
};

struct ProofCase {
  const char* name;
  ProofScene scene;
  Samples samples;  // 0: that strategy cannot find this light in any time
  bool has_sky;
  int bounces;
};

void PrintTo(const ProofCase& c, std::ostream* out) { *out << c.name; }

constexpr ProofCase kCases[] = {
    {"sphere under sun", ProofScene::sphere_under_sun, {0, 0, 4, 4}, true, 0},
    {"sphere under wide sun", ProofScene::sphere_under_wide_sun, {10, 3, 2, 1.7}, true, 0},
    {"rough metal under many lamps", ProofScene::metal_under_lamps, {4, 2, 1.3, 1.2}, false, 0},
    {"furnace", ProofScene::furnace, {1.5, 0.25, 4, 0.25}, true, 0},
    {"occluded corner", ProofScene::corner, {2.5, 1.2, 5, 1}, true, 0},
    {"two bounces", ProofScene::two_bounces, {15, 1.2, 2, 1.2}, true, 2},
};

double samples_of(const Samples& samples, Strategy strategy) {
  if (strategy == Strategy::uniform || strategy == Strategy::cosine) return samples.blind;
  if (strategy == Strategy::light) return samples.lights;
  return is_mixed(strategy) ? samples.mixed : samples.lobes;
}

/// Strategies that find a scene's light only with many samples are proven there by the long tests alone, and in the
/// other scenes by the short ones as well.
bool is_measured(const ProofCase& c, Strategy strategy) {
  const double samples = samples_of(c.samples, strategy);
  return samples > 0 && (samples < 10 || test::long_tests());
}

/// Independent numbers differ from a Sobol sequence's in what no scene changes.
bool has_random_numbers(const ProofCase& c) { return c.scene == ProofScene::corner || test::long_tests(); }

class Strategies : public ::testing::TestWithParam<ProofCase> {
 protected:
  void SetUp() override { skies_ = test::scratch_folder().string(); }

  PictureMeans measure(const Scene& scene, const NamedStrategy& s, Sequence sequence, double factor = 1,
                       uint64_t first_seed = 1) const {
    // A table takes longer than the samples that it serves: fewer, longer renders, and more samples because the error
    // of few renders is less well known.
    const bool few = s.strategy == Strategy::table;
    const int renders = few ? 8 : 32;
    const double samples = (few ? 2 : 1) * 4096 * factor * samples_of(GetParam().samples, s.strategy);
    RenderOptions options = test::small_options(s.strategy, static_cast<int>(samples / renders));
    options.width = options.height = 12;
    options.heuristic = s.heuristic;
    options.light_share = s.light_share;
    options.sequence = sequence;
    options.bounces = GetParam().bounces;
    options.cache_folder = skies_;
    return test::independent_renders(scene, options, renders, first_seed);
  }

  /// Means of the unchanged scene, measured once and shared by its tests.
  const PictureMeans& reference(const Scene& scene) const {
    static std::map<ProofScene, PictureMeans> known;
    const auto found = known.find(GetParam().scene);
    if (found != known.end()) return found->second;
    PictureMeans means = measure(scene, {"mis", Strategy::mis}, Sequence::random, 4, 1'000'000);
    return known.emplace(GetParam().scene, std::move(means)).first->second;
  }

  std::string skies_;  // folder of fits, which all renders of a test share
};

/// Sobol points err less; the dissertation's strategies have none.
double effort_of_sobol(Strategy strategy) {
  if (is_dissertations(strategy)) return 1;
  return strategy == Strategy::light ? 0.7 : 0.6;
}

TEST_P(Strategies, HaveTheSameExpectation) {
  const Scene scene = test::proof_scene(GetParam().scene);
  const PictureMeans& expected = reference(scene);
  test::ZTests tests(test::sidak_level(0.01, std::size(kCases)));
  std::vector<std::string> names;
  for (const NamedStrategy& s : test::all_strategies()) {
    if (!is_measured(GetParam(), s.strategy)) continue;
    names.push_back(s.name + " sobol");
    compare(names.back(), measure(scene, s, Sequence::sobol, effort_of_sobol(s.strategy)), expected, tests);
    if (!s.usual() || !has_random_numbers(GetParam())) continue;
    names.push_back(s.name + " random");
    compare(names.back(), measure(scene, s, Sequence::random), expected, tests);
  }
  EXPECT_TRUE(tests.agree());
  double least_seen = 0;
  for (const std::string& name : names) {
    const double bias = tests.smallest_bias(name + " whole");
    EXPECT_LT(bias, kPower) << name;
    least_seen = std::max(least_seen, bias);
  }
  RecordProperty("smallest_bias_seen_by_all", std::to_string(least_seen));
}

TEST_P(Strategies, ControlLightFivePercentTooBrightIsSeen) {
  const Scene scene = test::proof_scene(GetParam().scene);
  const Scene brighter = test::proof_scene(GetParam().scene, {.light = 1.05f});
  test::ZTests tests;
  compare("brighter", measure(brighter, {"mis", Strategy::mis}, Sequence::sobol), reference(scene), tests);
  EXPECT_TRUE(tests.differ());
}

/// Scenes whose light surfaces can find: the wide sun stands for the other.
class SurfaceStrategies : public Strategies {};

TEST_P(SurfaceStrategies, ControlADensityFivePercentTooHighIsSeen) {
  const Scene scene = test::proof_scene(GetParam().scene);
  const Scene wrong = test::proof_scene(GetParam().scene, {.density = 1.05f});
  test::ZTests tests;
  compare("denser", measure(wrong, {"srbf", Strategy::srbf}, Sequence::sobol), reference(scene), tests);
  EXPECT_TRUE(tests.differ());
}

/// Without products `product` is `mis` bit for bit, so a pixel that differs has them.
TEST_P(Strategies, ProductsAreMadeWhereThereIsASky) {
  const Scene scene = test::proof_scene(GetParam().scene);
  RenderOptions options = test::small_options(Strategy::mis);
  options.cache_folder = skies_;
  options.sequence = Sequence::random;
  const auto mis = test::rendered(scene, options);
  options.strategy = Strategy::product;
  const auto product = test::rendered(scene, options);
  int lit = 0, differ = 0;
  for (size_t i = 1; i < mis.size(); i += 4) {
    lit += mis[i] > 0 || product[i] > 0;
    differ += mis[i] != product[i];
  }
  EXPECT_GT(lit, 30);
  if (GetParam().has_sky) {
    EXPECT_GT(differ, lit / 2);
  } else {
    EXPECT_EQ(differ, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Strategies, ::testing::ValuesIn(kCases));
INSTANTIATE_TEST_SUITE_P(Scenes, SurfaceStrategies, ::testing::ValuesIn(std::begin(kCases) + 1, std::end(kCases)));

}  // namespace
}  // namespace velour::strategies_test
