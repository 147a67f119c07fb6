// Observations of several frames.
#include "usage/observation.h"

#include <gtest/gtest.h>

#include "support/example_observation.h"

namespace velour::observation_test {
namespace {

SceneObservation merged(SceneObservation into, const SceneObservation& other) {
  merge(into, other);
  return into;
}

TEST(Observation, FramesMergeInAnyOrder) {
  const auto a = test::example_observation(700, 1), b = test::example_observation(900, 2);
  const auto ab = merged(a, b), ba = merged(b, a);
  EXPECT_EQ(content_hash(ab), content_hash(ba));
  EXPECT_EQ(ab.domain.hash, ba.domain.hash);
  EXPECT_EQ(ab.domain.camera_rays, 6400u);
  EXPECT_EQ(ab.domain.frames, 2u);
  EXPECT_EQ(ab.domain.weight(), 1600);
}

TEST(Observation, TheSmallestKeysStayWithTheirTerms) {
  const auto a = test::example_observation(700, 1), b = test::example_observation(900, 2), ab = merged(a, b);
  ASSERT_EQ(ab.hits.size(), SceneObservation::kHits);
  for (const ObservedHit& hit : ab.hits) {
    const auto& from = std::ranges::find(a.hits, hit.key, &ObservedHit::key) != a.hits.end() ? a : b;
    const auto original = std::ranges::find(from.hits, hit.key, &ObservedHit::key);
    ASSERT_NE(original, from.hits.end());
    EXPECT_EQ(hit.light_density, original->light_density);
    EXPECT_EQ(hit.middle - hit.first, original->middle - original->first);
    EXPECT_EQ(ab.light[hit.last - 1], from.light[original->last - 1]);
  }
  for (const auto* from : {&a, &b}) {
    for (const ObservedHit& hit : from->hits) {
      const bool kept = std::ranges::find(ab.hits, hit.key, &ObservedHit::key) != ab.hits.end();
      EXPECT_EQ(kept, hit.key <= ab.hits.back().key);
    }
  }
}

TEST(Observation, TheHashTellsEveryPartApart) {
  const auto a = test::example_observation(5);
  const auto differs = [&a](const auto& change) {
    SceneObservation other = a;
    change(other);
    return content_hash(other) != content_hash(a);
  };
  EXPECT_FALSE(differs([](SceneObservation&) {}));
  EXPECT_TRUE(differs([](SceneObservation& o) { o.domain.view[7] += 1; }));
  EXPECT_TRUE(differs([](SceneObservation& o) { o.domain.light_density += 1; }));
  EXPECT_TRUE(differs([](SceneObservation& o) { o.hits[3].key += 1; }));
  EXPECT_TRUE(differs([](SceneObservation& o) { o.hits[3].light_density += 1; }));
  EXPECT_TRUE(differs([](SceneObservation& o) { o.light.back().b += 1; }));
  EXPECT_TRUE(differs([](SceneObservation& o) { o.wl.front().x += 1; }));
}

TEST(Observation, ItsReflectedPartHasNoLightFromTheOtherSide) {
  SceneObservation all = test::example_observation(9);
  const SceneObservation reflected = all;
  // Behind every term another one from below, at another light.
  all.wl.clear();
  all.light.clear();
  for (size_t i = 0; i < reflected.wl.size(); ++i) {
    all.wl.insert(all.wl.end(), {reflected.wl[i], -reflected.wl[i]});
    all.light.insert(all.light.end(), {reflected.light[i], Rgb(7)});
  }
  for (ObservedHit& hit : all.hits) {
    for (uint32_t* i : {&hit.first, &hit.middle, &hit.last}) *i *= 2;
  }
  EXPECT_NE(content_hash(all), content_hash(reflected));
  EXPECT_EQ(content_hash(reflected_part(all)), content_hash(reflected));
}

TEST(Observation, HashesSurviveTheirText) {
  const auto hash = test::example_observation(1).domain.hash;
  EXPECT_EQ(parse_hash(hash_text(hash)), hash);
  EXPECT_EQ(hash_text({1, 0, 0, 0xabcdef0123456789}).substr(0, 20), "00000000000000010000");
  EXPECT_FALSE(parse_hash(hash_text(hash).substr(1)));
  EXPECT_FALSE(parse_hash(std::string(64, 'g')));
}

}  // namespace
}  // namespace velour::observation_test
