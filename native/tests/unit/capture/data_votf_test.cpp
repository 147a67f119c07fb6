#include "votf/capture/data_votf.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "btf/formats/load_btf.h"
#include "btf/measure/pair_layout.h"
#include "capture/tile/tile.h"
#include "image/picture.h"
#include "support/captured.h"
#include "votf/capture/votf_capture.h"

namespace velour::data_votf_test {
namespace {

constexpr uint32_t kTexels = 64;

std::unique_ptr<Scene> scene_of(const Tile& tile) {
  const TileMesh& m = tile.parts.mesh;
  return test::tile_of(Mesh({.positions = m.positions, .triangles = m.triangles, .corner_normals = m.corner_normals}),
                       std::make_shared<test::Lambert>(0.5f));
}

/// A capture of a tile under one light, in a folder.
struct CapturedTile {
  explicit CapturedTile(const std::string& kind)
      : folder("data_occlusion_" + kind), tile(make_tile({.kind = kind})), scene(scene_of(tile)) {
    BtfCaptureOptions options = test::small_capture(bonn_directions(), {{0, 0}});
    options.place.period = tile.period;
    options.texels[0] = options.texels[1] = kTexels;
    options.sides = CaptureSides::automatic;
    options.sampling.samples = 16;
    options.sampling.bounces = 0;
    Progress progress;
    capture_btf(*scene, options, folder.path(), progress);
    btf = load_btf(folder.path());
  }

  /// Share of texel centers and unseen views whose visibility the volume gets wrong.
  double wrong(const VotfVolume& volume) const {
    const ShellField field(std::make_shared<const VotfVolume>(volume));
    const RepeatedTile repeated(*scene, {{0, 0}, tile.period}, 2);
    const TileTexels texels{kTexels, kTexels, 1};
    const float reference = static_cast<float>(btf->shell()->reference_height) + repeated.bottom();
    double wrong = 0;
    for (uint32_t i = 0; i < kViews; ++i) {
      const Vec3 wv = check_view(7, i);
      const auto truth = traced_mask(repeated, texels, reference, wv), found = visibility_mask(field, texels, wv);
      for (size_t t = 0; t < truth.size(); ++t) wrong += truth[t] != found[t] ? 1 : 0;
    }
    return wrong / static_cast<double>(kViews * texels.size());
  }

  static constexpr uint32_t kViews = 32;
  const test::ScratchFolder folder;
  const Tile tile;
  const std::unique_ptr<Scene> scene;
  std::shared_ptr<const BtfMeasurement> btf;
};

class DataVotf : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    net = std::make_unique<CapturedTile>("net");
    chainmail = std::make_unique<CapturedTile>("chainmail");
    gravel = std::make_unique<CapturedTile>("gravel");
  }
  static void TearDownTestSuite() {
    net.reset();
    chainmail.reset();
    gravel.reset();
  }
  static inline std::unique_ptr<const CapturedTile> net, chainmail, gravel;
};

VotfCapture fused(const BtfMeasurement& btf, int threads = 2) {
  Progress progress;
  return votf_of_data(btf, {.check_views = 16, .threads = threads}, progress);
}

/// Mean difference of the distances that both find within one and a half pitches of the surface, pitches.
double difference(const VotfVolume& a, const VotfVolume& b) {
  const float pitches = a.reach / a.pitch() / VotfVolume::kUnits;
  double sum = 0;
  size_t near = 0;
  for (size_t i = 0; i < a.distance.size(); ++i) {
    if (pitches * static_cast<float>(std::abs(a.distance[i] - VotfVolume::kZero)) > 1.5f) continue;
    sum += static_cast<double>(pitches * static_cast<float>(std::abs(a.distance[i] - b.distance[i])));
    ++near;
  }
  return sum / static_cast<double>(near);
}

TEST_F(DataVotf, OfANetSeesWhatRaysSee) {
  const VotfCapture c = fused(*net->btf);
  EXPECT_FALSE(c.volume.closed);
  EXPECT_LT(c.errors->wrong, 0.035) << "of texels of which a fifth is partly covered, by 9 lines each";
  EXPECT_LT(net->wrong(c.volume), 0.026);
  EXPECT_GT(chainmail->wrong(c.volume), 0.2) << "another tile";
  const VotfCapture rings = fused(*chainmail->btf);
  EXPECT_LT(rings.errors->wrong, 0.01);
  EXPECT_LT(chainmail->wrong(rings.volume), 0.01);
  EXPECT_EQ(c.volume.distance, fused(*net->btf, 1).volume.distance);
}

TEST_F(DataVotf, OfAClosedTileHasItsRelief) {
  const VotfCapture c = fused(*gravel->btf);
  EXPECT_TRUE(c.volume.closed);
  EXPECT_EQ(gravel->wrong(c.volume), 0.0);
  Progress progress;
  VotfCaptureOptions options;
  options.place.period = gravel->tile.period;
  options.texels = kTexels;
  options.reference_height = 0;
  const VotfCapture exact = capture_votf(*gravel->scene, options, progress);
  ASSERT_EQ(exact.volume.depth, c.volume.depth);
  EXPECT_LT(difference(exact.volume, c.volume), 0.3);
  VotfVolume flat = c.volume;  // what would be left of it without heights
  std::ranges::fill(flat.distance, uint8_t{VotfVolume::kZero});
  EXPECT_GT(difference(exact.volume, flat), 0.5);
}

/// Pictures of the coverage of a capture's views from above, with alpha or without, and their index.
std::string pictures(const CapturedTile& captured, const std::string& folder, int channels) {
  std::filesystem::create_directories(folder);
  std::string index = "file,theta_l,phi_l,theta_v,phi_v\n";
  const auto& views = captured.btf->layout().views();
  for (uint32_t v = 0; v < views.size(); ++v) {
    if (views[v].theta > 90) continue;
    Picture picture{static_cast<int>(kTexels), static_cast<int>(kTexels), channels, {}};
    const std::vector<float> coverage = captured.btf->read_coverage(v).value();
    for (const float c : coverage) {
      picture.pixels.insert(picture.pixels.end(), {0.5f * c, 0.5f * c, 0.5f * c});
      if (channels == 4) picture.pixels.push_back(c);
    }
    const std::string name = std::to_string(v) + ".png";
    write_picture(folder + "/" + name, picture);
    index += name + ",0,0," + std::to_string(views[v].theta) + "," + std::to_string(views[v].phi) + "\n";
  }
  const std::string path = folder + "/btf.csv";
  std::ofstream(path) << index;
  return path;
}

TEST_F(DataVotf, OfPicturesWithAlphaIsTheirVisualHull) {
  const test::ScratchFolder folder("data_occlusion_pictures");
  const auto btf = load_btf(pictures(*net, folder.path() + "/alpha", 4));
  const VotfCapture c = fused(*btf);
  EXPECT_FALSE(c.volume.closed);
  EXPECT_LT(c.errors->wrong, 0.03);
  EXPECT_LT(net->wrong(c.volume), 0.025);
  const float thickness = static_cast<float>(net->btf->shell()->thickness) / net->btf->grid().tile_metres->x;
  EXPECT_NEAR(c.volume.top - c.volume.bottom, thickness, 0.1f) << "looked for on a coarse grid";
  try {
    fused(*load_btf(pictures(*net, folder.path() + "/plain", 3)));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::unsupported);
    EXPECT_NE(std::string(error.what()).find("images with alpha"), std::string::npos);
  }
}

TEST_F(DataVotf, OfClosedPicturesIsRefused) {
  const test::ScratchFolder folder("data_occlusion_closed");
  EXPECT_THROW(fused(*load_btf(pictures(*gravel, folder.path(), 4))), Error);
}

TEST_F(DataVotf, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(votf_of_data(*net->btf, {}, progress), Error);
}

}  // namespace
}  // namespace velour::data_votf_test
