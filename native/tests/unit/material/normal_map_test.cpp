#include "material/normal_map.h"

#include <gtest/gtest.h>

#include "material/bsdf_materials.h"
#include "material/principled/principled_material.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/materials.h"
#include "support/textured_materials.h"

namespace velour::normal_map_test {
namespace {

std::shared_ptr<const Material> white() { return make_principled_material({.base_color = Rgb(1), .specular = 0}); }

std::shared_ptr<const Material> mapped(const Vec3& normal, float strength = 1) {
  return make_normal_mapped(white(), {test::one_texel(0.5f + 0.5f * normal), strength}, ReliefPart::lobe);
}

float f_of(const Material& material, const Vec3& wv, const Vec3& wl, const Mat3& relief = Mat3(1.0f)) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, {.relief = relief}, {}, arena);
  return kPi * test::eval_one(*point, wl).f.g;
}

const Vec3 kView = direction(0.3f, 1);

TEST(NormalMap, FlatOnesChangeNothing) {
  for (const Vec3& wl : hemisphere_fibonacci(20)) EXPECT_NEAR(f_of(*mapped({0, 0, 1}), kView, wl), 1, 1e-5f);
}

TEST(NormalMap, ShadesByTheCosineWithTheMappedNormal) {
  const Vec3 normal = direction(0.5f, 2);
  int lit = 0;
  for (const Vec3& wl : hemisphere_fibonacci(100)) {
    const float expected = std::max(glm::dot(normal, wl), 0.0f);
    EXPECT_NEAR(f_of(*mapped(normal), kView, wl) * wl.z, expected, 1e-5f);
    lit += expected > 0;
  }
  EXPECT_LT(lit, 100);  // some of it is behind the mapped normal
  EXPECT_EQ(f_of(*mapped(normal), kView, {0.8f, 0, -0.6f}), 0);
}

TEST(NormalMap, FollowsTheRelief) {
  const Vec3 normal = direction(0.5f, 0), wl = direction(0.4f, 0.3f);
  const Mat3 mirrored({1, 0, 0}, {0, -1, 0}, {0, 0, 1}), turned({0, 2, 0}, {-2, 0, 0}, {0, 0, 2});
  const auto by = [&](const Mat3& relief, const Vec3& n) { return f_of(*mapped(n), kView, wl, relief) * wl.z; };
  EXPECT_NEAR(by(turned, normal), glm::dot(direction(0.5f, kPi / 2), wl), 1e-5f);
  EXPECT_NEAR(by(mirrored, direction(0.5f, 1)), glm::dot(direction(0.5f, -1), wl), 1e-5f);
  EXPECT_NEAR(by(Mat3(0.0f), normal), wl.z, 1e-5f);  // a mesh without texture coordinates
}

TEST(NormalMap, StrengthScalesTheTilt) {
  const Vec3 normal = direction(0.5f, 2), wl = direction(0.4f, 2.5f);
  EXPECT_NEAR(f_of(*mapped(normal, 0), kView, wl), 1, 1e-5f);
  const Vec3 half = glm::normalize(Vec3(0.5f * normal.x, 0.5f * normal.y, 0.5f + 0.5f * normal.z));
  EXPECT_NEAR(f_of(*mapped(normal, 0.5f), kView, wl) * wl.z, glm::dot(half, wl), 1e-5f);
  const Vec3 more = glm::normalize(Vec3(2 * normal.x, 2 * normal.y, normal.z));
  EXPECT_NEAR(f_of(*mapped(normal, 2), kView, wl) * wl.z, glm::dot(more, wl), 1e-5f);
}

TEST(NormalMap, DiffuseLightFadesOutBeforeTheHorizon) {
  EXPECT_EQ(terminator_softening(0.5f, 0.5f, 1), 1);  // flat
  EXPECT_EQ(terminator_softening(0.6f, 0.5f, 0.8f), 1);
  EXPECT_EQ(terminator_softening(-0.1f, 0.5f, 0.8f), 0);
  EXPECT_NEAR(terminator_softening(0.2f, 0.5f, 0.8f), 0.5f + 0.25f - 0.125f, 1e-6f);
  const Vec3 normal = direction(0.9f, 0), low = direction(1.5f, 0);
  const NormalMap map{test::one_texel(0.5f + 0.5f * normal), 1};
  const auto value = [&](std::shared_ptr<const Material> material, ReliefPart part) {
    return f_of(*make_normal_mapped(std::move(material), map, part), direction(0.6f, 0), low) * low.z;
  };
  const float hard = glm::dot(normal, low), kept = terminator_softening(low.z, hard, normal.z);
  EXPECT_LT(kept, 0.3f);
  EXPECT_NEAR(value(white(), ReliefPart::lobe), hard, 1e-5f);
  EXPECT_NEAR(value(white(), ReliefPart::diffuse), kept * hard, 1e-5f);
}

TEST(NormalMap, ReliefShadowsAsItsTiltIsSteep) {
  EXPECT_EQ(relief_shadowing(0.5f, 1), 1);  // flat
  EXPECT_EQ(relief_shadowing(1, 0.3f), 1);
  EXPECT_EQ(relief_shadowing(-0.1f, 0.8f), 0);
  // A tilt of 45 degrees: alpha^2 is an eighth.
  EXPECT_NEAR(relief_shadowing(0.5f, std::sqrt(0.5f)), 2 / (1 + std::sqrt(1 + 3.0f / 8)), 1e-6f);
  EXPECT_NEAR(relief_shadowing(0.5f, 0.01f), 2 / (1 + std::sqrt(1 + 3.0f)), 1e-6f);  // no rougher than 1
  EXPECT_NEAR(relief_shadowing(0.5f, 0), 2 / (1 + std::sqrt(1 + 3.0f)), 1e-6f);
}

TEST(NormalMap, AViewerBehindTheMappedNormalSeesItsHorizon) {
  const Vec3 normal = direction(0.7f, 0), wl = direction(0.5f, 0.4f), wv = direction(1.3f, kPi);
  const NormalMap map{test::one_texel(0.5f + 0.5f * normal), 1, ReliefCorrection::none};
  const auto glossy = make_glossy_material({.roughness = 0.6f});
  const Frame frame = Frame::about(normal);
  Vec3 horizon = frame.to_local(wv);
  ASSERT_LT(horizon.z, -0.3f);
  horizon = glm::normalize(Vec3(horizon.x, horizon.y, 1e-3f));
  const float expected = f_of(*glossy, horizon, frame.to_local(wl)) * glm::dot(normal, wl);
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(f_of(*make_normal_mapped(glossy, map, ReliefPart::lobe), wv, wl) * wl.z / expected, 1, 1e-4f);
}

/// What a smooth dielectric leaves to the base below it depends on the view alone, about the lobe's own normal.
TEST(NormalMap, ABaseIsDimmedAboutTheNormalOfTheLobe) {
  const Vec3 normal = direction(0.7f, 0), wl = direction(0.5f, 0.4f), wv = direction(1.3f, kPi);
  const NormalMap map{test::one_texel(0.5f + 0.5f * normal), 1, ReliefCorrection::shadowed};
  const auto base = make_principled_material({.roughness = 0.2f, .part = PrincipledPart::base});
  ScratchArena arena;
  const auto material = make_normal_mapped(base, map, ReliefPart::base);
  const PreparedBrdf* const point = material->prepare(wv, {.relief = Mat3(1.0f), .ground = {0, 0, 1}}, {}, arena);
  const Vec3 turned = with_mirror_above(normal, {0, 0, 1}, wv);
  const float expected = f_of(*base, direction(std::acos(glm::dot(turned, wv)), 0), {0, 0, 1}) * glm::dot(normal, wl) *
                         relief_shadowing(wl.z, normal.z);
  EXPECT_NEAR(kPi * test::eval_one(*point, wl).f.g * wl.z, expected, 1e-4f);
  const float cosine_of_mapped = std::max(glm::dot(normal, wv), 1e-3f);
  const float unturned = f_of(*base, direction(std::acos(cosine_of_mapped), 0), {0, 0, 1});
  EXPECT_GT(std::abs(unturned / f_of(*base, direction(std::acos(glm::dot(turned, wv)), 0), {0, 0, 1}) - 1), 0.05f);
}

/// The light is low, and the mirror image of the view would be below the ground.
TEST(NormalMap, CorrectionsDiffer) {
  const Vec3 normal = direction(0.9f, 0), low = direction(1.5f, 0), wv = direction(1.2f, kPi);
  ASSERT_GT(glm::dot(with_mirror_above(normal, {0, 0, 1}, wv), {0, 0, 1}), normal.z + 0.1f);
  ASSERT_LT(glm::dot(normal, wv), 0);  // and it is behind the mapped normal
  const auto value = [&](ReliefCorrection correction, ReliefPart part) {
    const NormalMap map{test::one_texel(0.5f + 0.5f * normal), 1, correction};
    ScratchArena arena;
    const auto material = make_normal_mapped(white(), map, part);
    const PreparedBrdf* const point = material->prepare(wv, {.relief = Mat3(1.0f), .ground = {0, 0, 1}}, {}, arena);
    return kPi * test::eval_one(*point, low).f.g * low.z;
  };
  const float hard = glm::dot(normal, low), shadowed = relief_shadowing(low.z, normal.z);
  const float faded = terminator_softening(low.z, hard, normal.z);
  EXPECT_LT(shadowed, 0.5f);
  EXPECT_GT(std::abs(shadowed - faded), 0.05f);
  EXPECT_NEAR(value(ReliefCorrection::none, ReliefPart::diffuse), hard, 1e-4f);
  EXPECT_NEAR(value(ReliefCorrection::shadowed, ReliefPart::diffuse), shadowed * hard, 1e-4f);
  const float turned = glm::dot(with_mirror_above(normal, {0, 0, 1}, wv), low);
  EXPECT_LT(turned, hard - 0.05f);
  EXPECT_NEAR(value(ReliefCorrection::faded, ReliefPart::diffuse), faded * hard, 1e-4f);
  for (const auto correction : {ReliefCorrection::turned, ReliefCorrection::faded, ReliefCorrection::shadowed}) {
    EXPECT_NEAR(value(correction, ReliefPart::lobe), turned, 1e-4f);
  }
  EXPECT_LT(value(ReliefCorrection::turned, ReliefPart::diffuse), turned);
  EXPECT_NEAR(value(ReliefCorrection::none, ReliefPart::lobe), hard, 1e-4f);
}

/// Over random normals, grounds and views: what the view's mirror image needs, and no more.
TEST(NormalMap, MirrorImagesStayAboveTheGround) {
  int turned = 0;
  for (uint64_t i = 0; i < 20000; ++i) {
    RandomStream random(1, 0, i);
    const Vec3 ground = sample_cosine_hemisphere(random.next2());
    Vec3 wv = sample_cosine_hemisphere(random.next2());
    wv = Frame::about(ground).to_world(wv);
    const Vec3 normal = glm::normalize(Frame::about(ground).to_world(sample_cosine_hemisphere(random.next2())));
    const Vec3 found = with_mirror_above(normal, ground, wv);
    const auto height = [&](const Vec3& n) { return 2 * glm::dot(wv, n) * glm::dot(n, ground) - glm::dot(wv, ground); };
    const float least = std::min(0.01f, 0.9f * glm::dot(wv, ground));
    ASSERT_NEAR(glm::length(found), 1, 1e-5f);
    ASSERT_GT(height(found), least - 1e-5f);
    ASSERT_GT(glm::dot(found, wv), 0);
    if (height(normal) >= least) {
      ASSERT_EQ(found, normal);
    } else {
      ASSERT_NEAR(height(found), least, 1e-5f);
      ASSERT_NEAR(glm::dot(found, glm::cross(normal, ground)), 0, 1e-5f);  // between both
      ASSERT_GT(glm::dot(found, ground), glm::dot(normal, ground));
      ++turned;
    }
  }
  EXPECT_GT(turned, 1000);
}

}  // namespace
}  // namespace velour::normal_map_test
