// Shells in pictures: what is seen, what is seen through, what throws a shadow.
#include <gtest/gtest.h>

#include "btf/eval/sided_btf_material.h"
#include "image/texels.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "render/path/shadow_queue.h"
#include "render/path/shell_crossing.h"
#include "render/path/vertex.h"
#include "support/example_shell.h"
#include "support/test_scene.h"
#include "support/warnings.h"

namespace velour::shell_render_test {
namespace {

constexpr float kRadius = 0.2f;  // of wires a tile apart

std::shared_ptr<const ShellField> field_of(std::shared_ptr<const VotfVolume> volume) {
  return std::make_shared<const ShellField>(std::move(volume));
}

/// A floor at half the height over the surface.
std::shared_ptr<const ShellField> closed_field() {
  auto volume = test::shell_of(16, 0, 0.5f, [](const Vec3& p) { return p.z - 0.25f; });
  volume->closed = true;
  return field_of(std::move(volume));
}

SurfaceMaterial shelled(std::shared_ptr<const ShellField> field, float albedo = 0.5f) {
  return {.material = std::make_shared<test::Lambert>(albedo), .shell = std::move(field)};
}

/// Square of side 2 in the plane z = 0; `tiles` along its sides.
Mesh tiled_square(float tiles) {
  const std::vector<Vec3> p = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Vec2> uv = {{0, 0}, {tiles, 0}, {tiles, tiles}, {0, 0}, {tiles, tiles}, {0, tiles}};
  return Mesh({.positions = p, .triangles = t, .corner_uvs = uv});
}

/// The unit sphere with `tiles` of them from pole to pole.
Mesh tiled_sphere(uint32_t n, float tiles) {
  const Mesh plain = test::sphere(n);
  std::vector<Vec2> uv;
  std::vector<Vec3> normals;
  for (const glm::uvec3& t : plain.triangles()) {
    const uint32_t row = 2 * n + 1;
    for (int k = 0; k < 3; ++k) {
      uv.push_back(Vec2(t[k] % row, t[k] / row) * (tiles / static_cast<float>(n)));
      normals.push_back(plain.positions()[t[k]]);
    }
  }
  return Mesh(
      {.positions = plain.positions(), .triangles = plain.triangles(), .corner_normals = normals, .corner_uvs = uv});
}

/// A strip along y whose profile has the slopes `from` to `to`, radians, around a bend of `radius`, with flat parts of
/// length `flat` beside it and the middle of the bend at the origin; `tile` meters a tile.
Mesh bent_strip(float from, float to, float radius, float flat, float tile) {
  constexpr uint32_t kBends = 8;
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uv;
  std::vector<glm::uvec3> triangles;
  const auto along = [](float slope) { return Vec3(std::cos(slope), 0, std::sin(slope)); };
  const float chord = 2 * radius * std::sin(std::abs(to - from) / (2 * kBends)), part = (to - from) / kBends;
  Vec3 at(0.0f);
  std::vector<Vec3> profile = {-flat * along(from), at};
  for (uint32_t i = 0; i < kBends; ++i)
    profile.push_back(at += chord * along(from + (static_cast<float>(i) + 0.5f) * part));
  profile.push_back(at + flat * along(to));
  const Vec3 middle = profile[1 + kBends / 2];
  float way = 0;
  for (uint32_t i = 0; i < profile.size(); ++i) {
    const float slope = from + part * static_cast<float>(std::clamp<int>(static_cast<int>(i) - 1, 0, kBends));
    if (i > 0) way += glm::length(profile[i] - profile[i - 1]);
    for (const float y : {-2.0f, 2.0f}) {
      positions.push_back(profile[i] - middle + Vec3(0, y, 0));
      normals.push_back({-std::sin(slope), 0, std::cos(slope)});
      uv.push_back(Vec2(way, y) / tile);
    }
    if (i > 0) triangles.insert(triangles.end(), {{2 * i - 2, 2 * i, 2 * i - 1}, {2 * i, 2 * i + 1, 2 * i - 1}});
  }
  std::vector<Vec3> corner_normals;
  std::vector<Vec2> corner_uvs;
  for (const glm::uvec3& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      corner_normals.push_back(normals[t[k]]);
      corner_uvs.push_back(uv[t[k]]);
    }
  }
  return Mesh(
      {.positions = positions, .triangles = triangles, .corner_normals = corner_normals, .corner_uvs = corner_uvs});
}

struct Shot {
  explicit Shot(Mesh mesh, SurfaceMaterial material, const Affine& place = {}) {
    scene.add_material(std::move(material));
    scene.add_instance(scene.add_mesh(std::move(mesh)), place, {0});
    scene.set_environment(Environment::constant(Rgb(1.0f)));
  }
  /// Mean alpha up to about `half` meters from the center, seen from above.
  double alpha(float half, int side = 64) { return test::mean_of(picture(half, side), 3); }
  std::vector<float> picture(float half, int side = 64) {
    scene.set_camera(test::camera_above(half));
    scene.commit(1);
    RenderOptions options = test::small_options(Strategy::cosine, 16);
    options.width = options.height = side;
    options.split = 1;
    options.transparent = true;
    return test::rendered(scene, options);
  }
  Scene scene;
};

TEST(ShellRender, OneSeesThroughBetweenWires) {
  // From above wires cover their width; perspective adds what it shows of their sides, within a percent here.
  Shot wires(tiled_square(64), shelled(field_of(test::wires(64, kRadius))));
  EXPECT_NEAR(wires.alpha(0.25f), 2 * kRadius, 0.004);
  Shot solid(tiled_square(64), {.material = std::make_shared<test::Lambert>(0.5f)});
  EXPECT_EQ(solid.alpha(0.25f), 1.0);
}

/// Tiles of 4 pixels to 57 a pixel: the samples of a pixel see the share that is covered. They vary about as if each
/// were decided by chance with that probability, which is what a pyramid of coverage would give them: less near a pixel
/// a tile, over which they are spread, and more where its period beats with theirs.
TEST(ShellRender, FromAfarThePixelsSamplesSeeWhatIsCovered) {
  const double covered = 2 * static_cast<double>(kRadius), by_chance = covered * (1 - covered) / 16;
  for (const float tiles_a_pixel : {0.25f, 1.0f, 2.0f, 7.3f, 32.0f, 57.3f}) {
    Shot wires(tiled_square(256 * tiles_a_pixel), shelled(field_of(test::wires(64, kRadius))));
    const std::vector<float> pixels = wires.picture(0.25f);
    const double mean = test::mean_of(pixels, 3);
    EXPECT_NEAR(mean, covered, 0.004) << tiles_a_pixel;
    double variance = 0;
    for (size_t i = 3; i < pixels.size(); i += 4) variance += std::pow(static_cast<double>(pixels[i]) - mean, 2);
    variance /= static_cast<double>(pixels.size() / 4);
    if (tiles_a_pixel < 1) {
      EXPECT_GT(variance, 2 * by_chance) << "the wires themselves are seen";
    } else {
      EXPECT_LT(variance, (tiles_a_pixel == 32 ? 2 : 1.05) * by_chance) << tiles_a_pixel;
    }
  }
}

TEST(ShellRender, AClosedShellOnAFlatSurfaceHidesAllBehind) {
  Shot closed(tiled_square(8), shelled(closed_field()));
  EXPECT_EQ(closed.alpha(0.5f), 1.0);
}

TEST(ShellRender, HasTheOutlineThatItsStructureHas) {
  // Four tiles from pole to pole are pi / 4 wide at the equator: the floor lies a quarter of that over the sphere.
  const float tile = kPi / 4, height = 0.25f * tile;
  const double area = kPiD * std::pow(1.0 + static_cast<double>(height), 2) / 16;
  Shot shell(tiled_sphere(64, 4), shelled(closed_field()));
  shell.scene.set_shell_tile(0, tile);
  shell.scene.set_camera(Camera::look_at({100, 0, 0}, {0, 0, 0}, {0, 0, 1}, 2 * std::atan(2.0f / 100), 1));
  shell.scene.commit(1);
  RenderOptions options = test::small_options(Strategy::cosine, 64);
  options.width = options.height = 64;
  options.split = 1;
  options.transparent = true;
  // The sphere of the floor's height; the smooth sphere is 30 % smaller, the shell's top 36 % larger.
  EXPECT_NEAR(test::mean_of(test::rendered(shell.scene, options), 3) / area, 1.0, 0.01);
  // All 32 tiles that the coordinates count are smaller on average than those of the equator.
  shell.scene.set_shell_tile(0, 0);
  shell.scene.commit(1);
  const double lower = std::pow(1.0 + 0.25 * std::sqrt(kPiD / 8), 2) / std::pow(1.0 + static_cast<double>(height), 2);
  EXPECT_NEAR(test::mean_of(test::rendered(shell.scene, options), 3) / area, lower, 0.01);
  EXPECT_THROW(shell.scene.set_shell_tile(1, 1), Error);
  EXPECT_THROW(shell.scene.set_shell_tile(0, -1), Error);
}

TEST(ShellRender, LightFallsThroughItsHolesAlone) {
  const auto lit = [](bool with_shell) {
    Scene scene;
    scene.add_material(with_shell ? shelled(field_of(test::wires(64, kRadius)))
                                  : SurfaceMaterial{.material = std::make_shared<test::Lambert>(0.5f)});
    scene.add_material({.material = std::make_shared<test::Lambert>(1.0f)});
    scene.add_instance(scene.add_mesh(tiled_square(64)), test::shift({0, 0, 1}), {0});
    scene.add_instance(scene.add_mesh(test::square(1)), {}, {1});
    // Straight down from a small far sun; the camera looks from below the wires at the floor's middle.
    Light sun;
    sun.color = Rgb(kPi);
    sun.angle = 0.2f;
    scene.add_light(sun);
    scene.set_camera(Camera::look_at({0, 0.01f, 0.9f}, {0, 0, 0}, {0, 1, 0}, 0.2f, 1));
    scene.commit(1);
    return test::mean_of(test::rendered(scene, test::small_options(Strategy::light, 4096)));
  };
  EXPECT_EQ(lit(false), 0.0);
  EXPECT_NEAR(lit(true), 1 - 2 * static_cast<double>(kRadius), 0.02);
}

TEST(ShellRender, FromInsideTheSameLinesAreBlocked) {
  Shot wires(tiled_square(64), shelled(field_of(test::wires(64, kRadius))));
  wires.scene.commit(1);
  const VisibleRays visible(wires.scene);
  int blocked = 0;
  for (int i = 0; i < 2000; ++i) {
    RandomStream numbers(3, static_cast<uint64_t>(i), 0);
    const Vec3 w = direction(radians_from(60.0f) * numbers.next(), 2 * kPi * numbers.next());
    const Vec3 at(0.4f * numbers.next() - 0.2f, 0.4f * numbers.next() - 0.2f, 0);
    const bool from_above = visible.occluded({at + w, 0, -w}), from_below = visible.occluded({at - w, 0, w});
    EXPECT_EQ(from_above, from_below) << i;
    blocked += from_above ? 1 : 0;
  }
  EXPECT_GT(blocked, 600);
  EXPECT_LT(blocked, 1700);
}

TEST(ShellRender, RaysFromItsSurfaceAreNotBlockedByTheFloorThatTheyLeave) {
  Shot closed(tiled_square(8), shelled(closed_field(), 1.0f));
  for (const bool shaded : {false, true}) {
    SurfaceMaterial material = shelled(closed_field(), 1.0f);
    material.shell_shaded = shaded;
    closed.scene.set_material(0, material);
    closed.scene.set_camera(test::camera_above(0.2f));
    closed.scene.commit(1);
    // White under white is white: a furnace without acne.
    EXPECT_NEAR(test::mean_of(test::rendered(closed.scene, test::small_options(Strategy::cosine, 256))), 1.0, 2e-3)
        << shaded;
  }
}

TEST(ShellRender, AMaterialInThePlaceOfOneWithTheSameShellNeedsNoNewHierarchy) {
  Shot wires(tiled_square(64), shelled(field_of(test::wires(64, kRadius))));
  wires.scene.set_shell_tile(0, 0.25f);
  wires.scene.commit(1);
  wires.scene.set_material(0, shelled(field_of(test::wires(64, kRadius))));
  EXPECT_TRUE(wires.scene.committed());
  EXPECT_EQ(wires.scene.materials()[0].shell_tile, 0.25f);
  wires.scene.set_material(0, shelled(field_of(test::wires(64, 2 * kRadius))));
  EXPECT_FALSE(wires.scene.committed());
  wires.scene.commit(1);
  wires.scene.set_material(0, {.material = std::make_shared<test::Lambert>(0.5f)});
  EXPECT_FALSE(wires.scene.committed());
}

TEST(ShellRender, ASoftEdgeIsFoundElsewhereByEachRay) {
  constexpr float kSoftness = 0.1f;
  constexpr int kRays = 4000;
  Shot wires(tiled_square(64), shelled(field_of(test::wires(128, kRadius))));
  wires.scene.commit(1);
  // Straight down, `beyond` widths beside a wire.
  const auto share = [&](float beyond) {
    int met = 0;
    for (int i = 0; i < kRays; ++i) {
      const float y = static_cast<float>(i) / kRays - 0.5f;
      met += VisibleRays(wires.scene).occluded({{(0.5f + kRadius + beyond) / 32, y, 2}, 0, {0, 0, -1}}) ? 1 : 0;
    }
    return static_cast<float>(met) / kRays;
  };
  EXPECT_EQ(share(-0.03f), 1);
  EXPECT_EQ(share(0.03f), 0);
  wires.scene.set_shell_softness(0, kSoftness);
  EXPECT_TRUE(wires.scene.committed());
  for (const float beyond : {-0.06f, -0.03f, 0.0f, 0.03f, 0.06f}) {
    const float expected = std::clamp(0.5f - beyond / kSoftness, 0.0f, 1.0f);
    // What counts as within, and the grid's distances, are off by up to 0.005 widths.
    EXPECT_NEAR(share(beyond), expected, 4 * 0.5 / std::sqrt(kRays) + 0.005 / kSoftness) << beyond;
  }
  wires.scene.set_shell_softness(0, 0.9f);  // farther than distances are stored
  EXPECT_EQ(share(0.3f), 0) << "the middle between two wires stays open";
  EXPECT_THROW(wires.scene.set_shell_softness(0, 1), Error);
  EXPECT_THROW(wires.scene.set_shell_softness(0, -0.1f), Error);
  EXPECT_THROW(wires.scene.set_shell_softness(1, 0), Error);
}

/// White structure as a BTF has it: texels hold the share that wires of kRadius about the middle cover of them.
class CoveredTexels : public test::Lambert {
 public:
  CoveredTexels() : Lambert(1.0f) {
    for (int x = 0; x < kTexels; ++x) {
      const float begin = static_cast<float>(x) / kTexels, end = begin + 1.0f / kTexels;
      covered_.push_back(std::max(0.0f, std::min(end, 0.5f + kRadius) - std::max(begin, 0.5f - kRadius)) * kTexels);
    }
  }
  bool varies() const override { return true; }
  Vec2 texels() const override { return {kTexels, 1}; }

 protected:
  float albedo(const SurfaceSite& site) const override {
    const BilinearTexels texels = bilinear_texels(site.uv, kTexels, 1);
    float sum = 0;
    for (size_t i = 0; i < 4; ++i) sum += texels.weight[i] * covered_[texels.index[i]];
    return sum;
  }

 private:
  static constexpr int kTexels = 18;
  std::vector<float> covered_;
};

TEST(ShellRender, ABtfThatHoldsTheHolesIsAsBrightWithThem) {
  const auto brightness = [](std::shared_ptr<const Material> btf) {
    Shot wires(tiled_square(64), {.material = std::move(btf), .shell = field_of(test::wires(64, kRadius))});
    wires.scene.set_camera(test::camera_above(0.25f));
    wires.scene.commit(1);
    RenderOptions options = test::small_options(Strategy::cosine, 64);
    options.split = 1;
    options.transparent = true;
    return test::mean_of(test::rendered(wires.scene, options));
  };
  const auto btf = std::make_shared<const CoveredTexels>();
  EXPECT_NEAR(brightness(std::make_shared<const HoledBtfMaterial>(btf)), 2 * kRadius, 0.01 * 2 * kRadius);
  EXPECT_LT(brightness(btf), 0.96 * 2 * kRadius) << "what lies beyond the outline is lost";
}

TEST(ShellRender, ABtfThatHoldsTheHolesIsLookedUpAtPoints) {
  // Whoever asks which of its texels a picture needs must hear of the finest.
  const auto footprint = [](bool shaded) {
    SurfaceMaterial material{.material = std::make_shared<CoveredTexels>(),
                             .shell = field_of(test::wires(64, kRadius))};
    material.shell_shaded = shaded;
    Shot wires(tiled_square(64), std::move(material));
    wires.scene.commit(1);
    const Ray ray{{1.0f / 64, 0.3f / 64, 2}, 0, {0, 0, -1}};  // onto the middle of a wire
    Hit hit;
    VisibleRays(wires.scene).intersect({&ray, 1}, &hit);
    EXPECT_NE(hit.instance, kNoHit);
    const Mat2 sides = Vertex::seen(wires.scene, ray, hit, {0, 0.01f}, nullptr).site.footprint;
    return glm::length(sides[0]) + glm::length(sides[1]);
  };
  EXPECT_EQ(footprint(false), 0.0f);
  EXPECT_GT(footprint(true), 0.0f);
}

TEST(ShellRender, UpToItsOutlineEveryPlaceHasItsMirrorImage) {
  Shot wires(tiled_square(64),
             {.material = std::make_shared<CoveredTexels>(), .shell = field_of(test::wires(64, kRadius))});
  wires.scene.commit(1);
  const float width = 2.0f / 64;
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const float inside = 2e-5f * static_cast<float>(i - 50);  // of the outline, tiles
    const Ray ray{{width * (0.5f + kRadius - inside), 0.3f * width, 2}, 0, {0, 0, -1}};
    Hit hit;
    VisibleRays(wires.scene).intersect({&ray, 1}, &hit);
    if (hit.instance == kNoHit) continue;
    ++met;
    const Vec2 beyond = Vertex::seen(wires.scene, ray, hit, {0, 0.01f}, nullptr).site.beyond_outline;
    if (inside > 2e-4f) {
      EXPECT_GT(beyond.x, 0.0f) << inside;
    } else if (inside < -2e-4f) {
      EXPECT_EQ(beyond.x, 0.0f) << inside;  // met within the march's tolerance alone
    }
    EXPECT_NEAR(beyond.x, 2 * std::max(inside, 0.0f), 0.004f) << inside;
  }
  EXPECT_GT(met, 140);
}

TEST(ShellRender, WhatRaysHaveFoundIsWhatIsShaded) {
  Shot shot(tiled_sphere(64, 8), shelled(field_of(test::wires(64, kRadius))));
  shot.scene.set_shell_tile(0, 0.3f);
  shot.scene.set_shell_softness(0, 0.05f);
  shot.scene.commit(1);
  std::vector<Ray> rays;
  for (uint64_t i = 0; i < 500; ++i) {
    RandomStream numbers(8, i, 0);
    const Vec3 at(0, 2.4f * numbers.next() - 1.2f, 2.4f * numbers.next() - 1.2f);
    rays.push_back({i % 2 == 0 ? at + Vec3(4, 0, 0) : 0.5f * at, 0, {-1, 0, 0}});
  }
  std::vector<Hit> hits(rays.size());
  VisibleRays(shot.scene).intersect(rays, hits.data());
  int met = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].instance == kNoHit) continue;
    EXPECT_FALSE(std::isnan(hits[i].shell_s)) << i;
    Hit unasked = hits[i];
    unasked.shell_s = std::numeric_limits<float>::quiet_NaN();
    const Vertex known = Vertex::seen(shot.scene, rays[i], hits[i], {0, 0}, nullptr),
                 found = Vertex::seen(shot.scene, rays[i], unasked, {0, 0}, nullptr);
    EXPECT_EQ(known.position, found.position) << i;
    EXPECT_EQ(known.frame.z, found.frame.z) << i;
    ++met;
  }
  EXPECT_GT(met, 150);
}

TEST(ShellRender, StructureOnASphereDoesNotBlockItsOwnRays) {
  // Places on wires found along grazing rays are found a little elsewhere along others.
  Shot shot(tiled_sphere(64, 8), shelled(field_of(test::wires(64, kRadius))));
  shot.scene.set_shell_tile(0, 0.3f);
  shot.scene.commit(1);
  const VisibleRays visible(shot.scene);
  int seen = 0, dark = 0;
  for (int i = 0; i < 4000; ++i) {
    RandomStream numbers(5, static_cast<uint64_t>(i), 0);
    const Ray ray{{4, 2.4f * numbers.next() - 1.2f, 2.4f * numbers.next() - 1.2f}, 0, {-1, 0, 0}};
    Hit hit;
    visible.intersect({&ray, 1}, &hit);
    if (hit.instance == kNoHit || glm::dot(hit.geometric_normal, ray.direction) > 0) continue;
    ShellCrossing crossing(shot.scene, ray, hit);
    EXPECT_TRUE(crossing.find());
    const SurfacePoint place = crossing.surface(shot.scene.surface(hit), true);
    const Frame frame = Frame::about(place.shading_normal);
    int open = 0;
    for (int k = 0; k < 32; ++k) {
      const Vec3 w = frame.to_world(sample_cosine_hemisphere(numbers.next2()));
      open += visible.occluded({place.position + 4 * place.error * place.geometric_normal, 0, w}) ? 0 : 1;
    }
    ++seen;
    dark += open < 4 ? 1 : 0;
  }
  // Between wires and deep on their sides some are dark indeed.
  EXPECT_GT(seen, 800);
  EXPECT_LT(dark, 0.02 * seen);
}

TEST(ShellRender, WithoutTextureCoordinatesTheSurfaceStaysAndSaysSo) {
  Shot bare(test::square(1), shelled(field_of(test::wires(16, kRadius))));
  EXPECT_EQ(bare.alpha(0.5f), 1.0);
  ASSERT_EQ(bare.scene.info().warnings.size(), 1u);
  EXPECT_EQ(bare.scene.info().warnings[0].code, WarningCode::silhouettes_without_uvs);
}

TEST(ShellRender, AShellHigherThanTheSurfaceBendsSaysSo) {
  const auto warnings = [](float tile, bool inside_out) {
    const Mesh outside = tiled_sphere(16, 4);
    std::vector<glm::uvec3> turned;
    std::vector<Vec3> normals;
    std::vector<Vec2> uvs;
    for (uint32_t t = 0; t < outside.triangles().size(); ++t) {
      const glm::uvec3& c = outside.triangles()[t];
      turned.push_back({c.x, c.z, c.y});
      const auto uv = outside.corner_uvs(t);
      for (const uint32_t k : {0u, 2u, 1u}) {
        normals.push_back(-outside.positions()[c[static_cast<int>(k)]]);
        uvs.push_back(uv[k]);
      }
    }
    Mesh hollow({.positions = outside.positions(), .triangles = turned, .corner_normals = normals, .corner_uvs = uvs});
    Shot shot(inside_out ? std::move(hollow) : tiled_sphere(16, 4), shelled(closed_field()));
    shot.scene.set_shell_tile(0, tile);
    shot.scene.commit(1);
    return shot.scene.info().warnings;
  };
  // Half a tile high, over a unit sphere.
  EXPECT_TRUE(warnings(4.0f, false).empty()) << "over the outside there is room";
  EXPECT_TRUE(warnings(1.8f, true).empty());
  const auto folded = warnings(2.2f, true);
  ASSERT_EQ(folded.size(), 1u);
  EXPECT_EQ(folded[0].code, WarningCode::silhouette_folds);
  EXPECT_NEAR(test::value_of<double>(folded[0], "radius"), 1, 0.005);
  EXPECT_FLOAT_EQ(static_cast<float>(test::value_of<double>(folded[0], "tile")), 2.2f);
}

/// The rays come in where the shell bends sharply and would leave at once if it went on so.
TEST(ShellRender, AClosedShellHidesAllBehindASharpRidge) {
  for (const float degrees : {30.0f, 60.0f, 75.0f}) {
    const float slope = radians_from(degrees);
    Shot ridge(bent_strip(slope, -slope, 0.01f, 2, 0.4f), shelled(closed_field()));
    EXPECT_EQ(ridge.alpha(0.3f), 1.0) << degrees;
  }
}

/// A trough narrower than the shell is high: its top is an arch that is turned over, which a ray from below enters.
TEST(ShellRender, RaysMeetAClosedShellWhereItsTopIsTurnedOver) {
  const float slope = radians_from(60.0f);
  Shot trough(bent_strip(-slope, slope, 0.1f, 0.5f, 0.4f), shelled(closed_field()));
  trough.scene.commit(1);
  const Ray ray{{0.01f, 0, -1}, 0, {0, 0, 1}};
  Hit hit;
  trough.scene.rays().intersect(ray, hit);
  ASSERT_NE(hit.instance, kNoHit);
  EXPECT_NEAR(hit.distance, 1.2f, 0.01f);
  EXPECT_LT(glm::dot(hit.geometric_normal, ray.direction), 0);
  EXPECT_TRUE(ShellCrossing(trough.scene, ray, hit).find());
}

TEST(ShellRender, StaysSaneWhereItHasNoMeaning) {
  struct Case {
    const char* name;
    Vec3 eye;
    float tile;
  };
  const Case cases[] = {{"from within", {0.1f, 0.2f, 0}, 0.5f},
                        {"tiles larger than the object", {0, -6, 0}, 20.0f},
                        {"no height", {0, -6, 0}, 1e-6f},
                        {"from within the shell", {0, -1.05f, 0}, 0.5f}};
  for (const Case& c : cases) {
    for (const bool open : {false, true}) {
      Shot shot(tiled_sphere(32, 4), shelled(open ? field_of(test::wires(16, kRadius)) : closed_field()));
      shot.scene.set_shell_tile(0, c.tile);
      shot.scene.set_camera(Camera::look_at(c.eye, {0, 0, 0.01f}, {0, 0, 1}, 0.6f, 1));
      shot.scene.commit(1);
      RenderOptions options = test::small_options(Strategy::cosine, 16);
      options.bounces = 2;
      const std::vector<float> pixels = test::rendered(shot.scene, options);
      for (const float v : pixels) ASSERT_TRUE(v >= 0 && v < 1.01f) << c.name << " " << open << " " << v;
    }
  }
}

TEST(ShellRender, At89DegreesAClosedTileHidesAll) {
  for (const float degrees : {80.0f, 89.0f, 89.9f}) {
    // Low enough for the rays to come in through its top.
    Shot closed(tiled_square(1024), shelled(closed_field()));
    closed.scene.set_camera(
        Camera::look_at(direction(radians_from(degrees), 0.3f) * 10.0f, {0, 0, 0}, {0, 0, 1}, 1e-4f, 1));
    closed.scene.commit(1);
    RenderOptions options = test::small_options(Strategy::cosine, 16);
    options.transparent = true;
    EXPECT_EQ(test::mean_of(test::rendered(closed.scene, options), 3), 1.0) << degrees;
  }
}

TEST(ShellRender, ItsHeightIsTheSameInTheWorldWhateverTheScaleOfTheObject) {
  // Squeezed along its normal: tiles are as wide as before, and so is the shell as high.
  const auto top_of = [](const Affine& place) {
    Shot shot(tiled_square(4), shelled(closed_field()), place);
    shot.scene.commit(1);
    return shot.scene.bounds().high.z;
  };
  EXPECT_NEAR(top_of({}), 0.25f, 1e-6f);  // half of a tile of 1/2
  EXPECT_NEAR(top_of(test::shift({0, 0, 0}, {1, 1, 0.1f})), 0.25f, 1e-6f);
  EXPECT_NEAR(top_of(test::shift({0, 0, 0}, {2, 2, 1})), 0.5f, 1e-6f);
  EXPECT_NEAR(top_of(test::shift({0, 0, 0}, {-1, 1, 1})), 0.25f, 1e-6f) << "mirrored";
}

}  // namespace
}  // namespace velour::shell_render_test
