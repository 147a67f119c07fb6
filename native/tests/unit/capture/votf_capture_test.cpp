#include "votf/capture/votf_capture.h"

#include <gtest/gtest.h>

#include "capture/tile/tile.h"
#include "support/captured.h"
#include "support/materials.h"
#include "votf/eval/shell_trace.h"

namespace velour::votf_capture_test {
namespace {

enum class Turned { none, half, all };

/// A tile whose lowest level is `level`, with the faces of every second triangle, or of all, turned inwards.
std::unique_ptr<Scene> scene_of(const std::string& kind, float level = 0, Turned turned = Turned::none) {
  const Tile tile = make_tile({.kind = kind});
  const TileMesh& m = tile.parts.mesh;
  std::vector<Vec3> positions = m.positions;
  for (Vec3& p : positions) p.z += level;
  std::vector<glm::uvec3> triangles = m.triangles;
  for (size_t i = 0; i < triangles.size(); ++i) {
    if (turned == Turned::all || (turned == Turned::half && i % 2 != 0)) std::swap(triangles[i].y, triangles[i].z);
  }
  return test::tile_of(Mesh({.positions = std::move(positions), .triangles = std::move(triangles)}),
                       std::make_shared<test::Lambert>(0.5f));
}

VotfCapture captured(const std::string& kind, uint32_t texels, float level = 0, Turned turned = Turned::none) {
  const Tile tile = make_tile({.kind = kind});
  Progress progress;
  VotfCaptureOptions options;
  options.place.period = tile.period;
  options.texels = texels;
  options.reference_height = options.surface = static_cast<double>(level);
  options.check_views = 16;
  return capture_votf(*scene_of(kind, level, turned), options, progress);
}

class OfTiles : public ::testing::TestWithParam<const char*> {};

TEST_P(OfTiles, SeesWhatRaysSee) {
  const VotfCapture c = captured(GetParam(), 128);
  EXPECT_TRUE(c.warnings.empty());
  EXPECT_LT(c.errors->wrong, 0.01);
}

TEST(VotfCapture, ANetCoversFromAboveWhatItsClosedFormSays) {
  const Tile tile = make_tile({.kind = "net"});
  const VotfCapture c = captured("net", 128);
  const ShellField field(std::make_shared<const VotfVolume>(c.volume));
  constexpr int kSide = 256;
  int met = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec2 place((static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide);
    met += line_meets(field, place, {0, 0, 1}) ? 1 : 0;
  }
  EXPECT_FALSE(c.volume.closed);
  EXPECT_NEAR(static_cast<double>(met) / (kSide * kSide), 1 - *tile.parts.open_area, 0.005);
}

TEST(VotfCapture, AClosedTileIsMetFromEverywhere) {
  const VotfCapture c = captured("corduroy", 32);
  EXPECT_TRUE(c.volume.closed);
  EXPECT_EQ(c.errors->coverage, 1.0);
  EXPECT_EQ(c.errors->wrong, 0.0);
}

TEST(VotfCapture, NormalsThatPointInwardsChangeNothing) {
  for (const char* const kind : {"net", "corduroy"}) {
    EXPECT_EQ(captured(kind, 32, 0, Turned::all).volume.distance, captured(kind, 32).volume.distance) << kind;
  }
}

TEST(VotfCapture, NormalsThatPointAnyWayAreWarnedOf) {
  const VotfCapture c = captured("net", 32, 0, Turned::half);
  EXPECT_GT(c.errors->wrong, 0.1);
  ASSERT_FALSE(c.warnings.empty());
  EXPECT_EQ(c.warnings.back().code, WarningCode::silhouette_differs);
}

/// A millimeter of thread ten meters above the plane z = 0, where floats are a micrometer apart.
TEST(VotfCapture, ATileFarFromTheOriginIsSeenAsNearIt) { EXPECT_LT(captured("net", 64, 10).errors->wrong, 0.03); }

TEST(VotfCapture, ASheetWithAHoleBecomesThinWithAWarning) {
  const auto scene = test::tile_of(test::Corners().rectangle(0, 0, 1, 0.5f, 0.3f).rectangle(0, 0.9f, 0.1f, 1).mesh(),
                                   std::make_shared<test::Lambert>(0.5f));
  Progress progress;
  VotfCaptureOptions options;
  options.place.period = {1, 1};
  options.texels = 32;
  options.reference_height = 0.3;
  const VotfCapture c = capture_votf(*scene, options, progress);
  ASSERT_FALSE(c.warnings.empty());  // of the seam as well
  EXPECT_EQ(c.warnings.back().code, WarningCode::sheets_thickened);
  const ShellField field(std::make_shared<const VotfVolume>(c.volume));
  EXPECT_TRUE(line_meets(field, {0.5f, 0.25f}, {0, 0, 1}));
  EXPECT_FALSE(line_meets(field, {0.5f, 0.75f}, {0, 0, 1}));
  EXPECT_GT(field.distance({0.5f, 0.25f, 0.1f}), 0) << "nothing is solid under it";
}

TEST(VotfCapture, SizesThatMakeNoGridAreRefused) {
  const auto scene = test::tile_of(test::sawtooth(), std::make_shared<test::Lambert>(0.5f));
  Progress progress;
  for (const uint32_t texels : {0u, 3u, 5000u}) {
    EXPECT_THROW(capture_votf(*scene, {.place = {}, .texels = texels}, progress), Error) << texels;
  }
  const auto tower =
      test::tile_of(test::Corners().rectangle(0, 0, 1, 1).quad({0, 0, 0}, {0, 1, 0}, {0, 1, 500}, {0, 0, 500}).mesh(),
                    std::make_shared<test::Lambert>(0.5f));
  EXPECT_THROW(capture_votf(*tower, {.place = {{0, 0}, {1, 1}}, .texels = 128}, progress), Error);
}

INSTANTIATE_TEST_SUITE_P(VotfCapture, OfTiles,
                         ::testing::Values("net", "chainmail", "weave", "twill", "gravel", "corduroy", "knit"));

}  // namespace
}  // namespace velour::votf_capture_test
