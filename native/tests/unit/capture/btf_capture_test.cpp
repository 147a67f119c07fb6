#include "capture/btf/btf_capture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <thread>

#include "base/job.h"
#include "capture/tile/tile.h"
#include "support/captured.h"
#include "support/warnings.h"
#include "votf/capture/votf_capture.h"

namespace velour::btf_capture_test {
namespace {

namespace fs = std::filesystem;
using test::Captured;
using test::Corners;
using test::ScratchFolder;
using test::small_capture;
using test::tile_of;

std::shared_ptr<const Material> lambert(float albedo) { return std::make_shared<test::Lambert>(albedo); }

const std::vector<PolarAngles> kFew = {{0, 0}, {45, 30}, {75, 200}, {89, 0}};

/// Name and bytes of every file.
std::vector<std::pair<std::string, std::string>> files_of(const std::string& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    files.emplace_back(entry.path().filename().string(), std::string(std::istreambuf_iterator<char>(stream), {}));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::pair<std::string, std::string>> captured_files(const Scene& scene, const BtfCaptureOptions& options,
                                                                const std::string& name) {
  const ScratchFolder folder(name);
  Progress progress;
  capture_btf(scene, options, folder.path(), progress);
  return files_of(folder.path());
}

TEST(BtfCapture, FlatLambertianTileIsAlbedoOverPiEverywhere) {
  const auto scene = tile_of(Corners().rectangle(0, 0, 1, 1, 0.3f).mesh(), lambert(0.5f));
  BtfCaptureOptions options = small_capture(kFew, kFew);
  options.reference_height.reset();
  const Captured captured(*scene, options, "flat");
  const float expected = 0.5f / kPi;
  for (const float value : captured.values) EXPECT_NEAR(value, expected, expected * 0x1p-11f);
  for (const float error : captured.errors) EXPECT_LT(error, 1e-4f * expected);
  for (const ViewStructure& view : captured.structure) {
    for (const float coverage : view.coverage) EXPECT_EQ(coverage, 1);
  }
  EXPECT_FALSE(captured.report.open);
  EXPECT_TRUE(captured.report.warnings.empty());
}

TEST(BtfCapture, NetsCoverWhatTheirBarsDo) {
  // Bars of 0.3 along x and of 0.2 along y, split by the border: 1 - 0.7 x 0.8 of the plane.
  Corners net;
  net.rectangle(0, 0.85f, 1, 1).rectangle(0, 0, 1, 0.15f).rectangle(0.4f, 0.15f, 0.6f, 0.85f);
  const auto scene = tile_of(net.mesh(), lambert(0.5f));
  BtfCaptureOptions options = small_capture({{0, 0}}, {{0, 0}});
  options.sides = CaptureSides::automatic;
  options.sampling.samples = 256;
  const Captured captured(*scene, options, "net");
  EXPECT_TRUE(captured.report.open);
  EXPECT_TRUE(captured.report.two_sided);
  ASSERT_EQ(captured.structure.size(), 2u);  // from above and from below
  for (const ViewStructure& view : captured.structure) {
    double covered = 0;
    for (const float c : view.coverage) covered += static_cast<double>(c) / 256;
    EXPECT_NEAR(covered, 1 - 0.7 * 0.8, 0.001);
  }
  // Pairs: above-above, above-below (light through opaque bars: none), below-above, below-below.
  EXPECT_GT(captured.mean(0).mean, 0.05);
  EXPECT_EQ(captured.mean(1).mean, 0);
  EXPECT_EQ(captured.mean(2).mean, 0);
  EXPECT_NEAR(captured.mean(3).mean, captured.mean(0).mean, 0.001);
}

TEST(BtfCapture, GeometryThatSticksOutIsThereOnBothSides) {
  // A square that crosses the corner of the cell covers a quarter of it, in four parts.
  const auto scene = tile_of(Corners().rectangle(0.75f, 0.75f, 1.25f, 1.25f).mesh(), lambert(0.5f));
  const Captured captured(*scene, small_capture({{0, 0}}, {{0, 0}}), "corner");
  for (size_t t = 0; t < 256; ++t) {
    const bool in = (t % 16 < 4 || t % 16 >= 12) && (t / 16 < 4 || t / 16 >= 12);
    EXPECT_EQ(captured.structure[0].coverage[t], in ? 1.0f : 0.0f) << t;
  }
}

TEST(BtfCapture, DoesNotDependOnThreadsOrMemory) {
  const auto scene = tile_of(test::sawtooth(), lambert(0.5f));
  BtfCaptureOptions options = small_capture(kFew, kFew);
  options.texels[0] = 40;
  options.threads = 1;
  const auto one = captured_files(*scene, options, "threads_1");
  options.threads = 4;
  EXPECT_EQ(captured_files(*scene, options, "threads_4"), one);
  options.memory_limit = 0;
  EXPECT_EQ(captured_files(*scene, options, "spilled"), one);
  options.sampling.seed += 1;
  EXPECT_NE(captured_files(*scene, options, "other_seed"), one) << "control";
}

TEST(BtfCapture, GoesOnAfterACancel) {
  const auto scene = tile_of(test::sawtooth(), lambert(0.5f));
  BtfCaptureOptions options = small_capture(kFew, kFew);
  options.sampling.samples = 256;
  const auto whole = captured_files(*scene, options, "uninterrupted");
  const ScratchFolder folder("interrupted");
  Progress progress;
  std::atomic<bool> ended{false};
  std::thread canceller([&] {
    while (!ended && !fs::exists(fs::path(folder.path()) / "view_0001.exr")) std::this_thread::yield();
    progress.cancel();
  });
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), progress), Error);
  ended = true;
  canceller.join();
  EXPECT_THROW(load_btf_folder(folder.path()), Error) << "an incomplete BTF is none";
  Progress again;
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), again), Error) << "not asked to resume";
  options.resume = true;
  const BtfCaptureReport report = capture_btf(*scene, options, folder.path(), again);
  EXPECT_GE(report.views_resumed, 1u);
  EXPECT_LT(report.views_resumed, 4u);
  EXPECT_EQ(files_of(folder.path()), whole);
  options.sampling.seed += 1;
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), again), Error) << "another capture";
}

TEST(BtfCapture, CancelsSoon) {
  const auto scene = tile_of(test::sawtooth(), lambert(0.5f));
  std::vector<double> seconds;
  for (int i = 0; i < 9; ++i) {
    BtfCaptureOptions options;
    options.place.period = {1, 1};
    options.sampling.samples = i % 2 == 0 ? 4096 : 1;
    const ScratchFolder folder("cancel");
    Job job([&](Progress& progress) { capture_btf(*scene, options, folder.path(), progress); });
    job.start();
    job.wait_for(0.05 * i);
    const auto start = std::chrono::steady_clock::now();
    job.cancel();
    ASSERT_TRUE(job.wait_for(10));
    EXPECT_EQ(job.poll().state, Job::State::cancelled);
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + 4, seconds.end());
  EXPECT_LT(seconds[4], 0.05) << "the median: whether we run at all is the machine's choice";
}

TEST(BtfCapture, ReferencePlaneOfASheetIsTheSheet) {
  // A checkered sheet high above a black floor: only at the sheet's height does every view see the same texels.
  Corners corners;
  corners.rectangle(0, 0, 1, 1, 0).rectangle(0, 0, 0.5f, 0.5f, 0.4f).rectangle(0.5f, 0.5f, 1, 1, 0.4f);
  auto scene = std::make_unique<Scene>();
  scene->add_material({.material = lambert(0.0f)});
  scene->add_material({.material = lambert(0.9f)});
  const std::vector<uint32_t> slots{0, 0, 1, 1, 1, 1};
  scene->add_instance(
      scene->add_mesh(Mesh({.positions = corners.positions, .triangles = corners.triangles, .material_slots = slots})),
      {}, {0, 1});
  scene->commit(1);
  BtfCaptureOptions options = small_capture({{0, 0}}, {{0, 0}});
  options.reference_height.reset();
  const Captured captured(*scene, options, "sheet");
  EXPECT_NEAR(captured.report.reference_height, 0.4, 0.4 / 32 + 1e-6);
  EXPECT_NEAR(captured.report.thickness, 0.4, 1e-6);
}

/// The silhouette of a tile lies on the plane of its BTF: of the front of a net on another than that of both sides.
TEST(BtfCapture, ReferencePlaneIsThatOfASilhouetteOfItsSides) {
  constexpr double kOfBothSides = 0.0012375;  // meters over the lowest point
  const Tile tile = make_tile({.kind = "net"});
  const TileMesh& m = tile.parts.mesh;
  const auto scene = tile_of(Mesh({.positions = m.positions, .triangles = m.triangles}), lambert(0.5f));
  BtfCaptureOptions options = small_capture({{0, 0}}, {{0, 0}});
  options.place.period = tile.period;
  options.reference_height.reset();
  options.sides = CaptureSides::one;
  const double captured = Captured(*scene, options, "front").report.reference_height;
  EXPECT_GT(captured - kOfBothSides, 1e-4);
  Progress progress;
  const VotfCaptureOptions silhouette{.place = options.place, .texels = 16, .two_sided = false, .check_views = 0};
  const VotfVolume shell = capture_votf(*scene, silhouette, progress).volume;
  double bottom = INFINITY;
  for (const Vec3& p : m.positions) bottom = std::min(bottom, static_cast<double>(p.z));
  EXPECT_NEAR(static_cast<double>(shell.reference * tile.period.x), bottom + captured, 1e-6);
}

TEST(BtfCapture, RefusesOrReportsWhatIsWrong) {
  Progress progress;
  const ScratchFolder folder("refused");
  Scene empty;
  empty.commit(1);
  EXPECT_THROW(capture_btf(empty, {}, folder.path(), progress), Error);
  const auto scene = tile_of(test::sawtooth(), lambert(0.5f));
  BtfCaptureOptions options = small_capture(kFew, kFew);
  options.place.period = {1, -1};
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), progress), Error);
  options.place.period = {0.001f, 0.001f};
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), progress), Error);
  options = small_capture(kFew, kFew);
  options.reference_height = -0.1;
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), progress), Error);
  options = small_capture(kFew, kFew);
  options.sampling.samples = 0;
  EXPECT_THROW(capture_btf(*scene, options, folder.path(), progress), Error);
  EXPECT_FALSE(fs::exists(folder.path()));
}

TEST(BtfCapture, SaysThatATileIsNotPeriodic) {
  const Mesh ramp = Corners().quad({0, 0, 0}, {1, 0, 0.3f}, {1, 1, 0.3f}, {0, 1, 0}).mesh();
  const Captured captured(*tile_of(ramp, lambert(0.5f)), small_capture({{0, 0}}, {{0, 0}}), "ramp");
  ASSERT_EQ(captured.report.warnings.size(), 1u);
  EXPECT_EQ(captured.report.warnings[0].code, WarningCode::tile_seam);
  EXPECT_EQ(test::value_of<std::string>(captured.report.warnings[0], "axis"), "x");
  const Captured grooves(*tile_of(test::sawtooth(), lambert(0.5f)), small_capture({{0, 0}}, {{0, 0}}), "grooves");
  EXPECT_TRUE(grooves.report.warnings.empty()) << "control";
}

TEST(BtfCapture, OddGeometryWorks) {
  // Without texture coordinates, crossing itself, and with a vertex that is no number.
  Corners odd;
  odd.rectangle(0, 0, 1, 1).quad({0.2f, 0.2f, -0.2f}, {0.8f, 0.2f, 0.2f}, {0.8f, 0.8f, 0.2f}, {0.2f, 0.8f, -0.2f});
  odd.quad({0, 0, std::numeric_limits<float>::quiet_NaN()}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  BtfCaptureOptions options = small_capture({{30, 0}}, {{60, 90}});
  options.sampling.samples = 1;
  const Captured captured(*tile_of(odd.mesh(), lambert(0.5f)), options, "odd");
  EXPECT_EQ(captured.report.warnings.size(), 1u);  // of the dropped triangles
  for (const float value : captured.values) EXPECT_TRUE(std::isfinite(value));
}

TEST(BtfCapture, SurfacesOfWhichPartIsThereLetTheRestThrough) {
  // Two sheets of alpha 0.5 over a floor that is whole. The upper one is met by half the rays, the lower one by a
  // quarter; light on the floor passes two sheets on its way, light on the lower sheet one.
  constexpr float kAlpha = 0.5f;
  Corners corners;
  corners.rectangle(0, 0, 1, 1, 0).rectangle(0, 0, 1, 1, 0.1f).rectangle(0, 0, 1, 1, 0.2f);
  auto scene = std::make_unique<Scene>();
  scene->add_material({.material = lambert(0.8f)});
  scene->add_material({.material = std::make_shared<test::ThinLambert>(0.8f, kAlpha)});
  const std::vector<uint32_t> slots{0, 0, 1, 1, 1, 1};
  scene->add_instance(
      scene->add_mesh(Mesh({.positions = corners.positions, .triangles = corners.triangles, .material_slots = slots})),
      {}, {0, 1});
  scene->commit(1);
  BtfCaptureOptions options = small_capture({{0, 0}, {60, 45}}, {{0, 0}, {70, 10}});
  options.sampling.samples = 1024;
  options.sampling.bounces = 0;
  const Captured captured(*scene, options, "sheets");
  const double expected = 0.8 / kPiD * (0.5 + 0.5 * 0.5 * 0.5 + 0.25 * 0.25);
  for (size_t pair = 0; pair < 4; ++pair) {
    const test::Estimate mean = captured.mean(pair);
    EXPECT_NEAR(mean.mean, expected, 4 * mean.error) << pair;
    EXPECT_GT(std::abs(mean.mean - 0.8 / kPiD * 0.5), 20 * mean.error) << "control: the upper sheet alone";
  }
}

TEST(BtfCapture, ViewsMirroredBelowASmoothFaceSeeTheCorrectedMaterial) {
  Corners flat;
  flat.rectangle(0, 0, 1, 1);
  const std::vector<Vec3> leaning(6, Vec3(0.5f, 0, std::sqrt(0.75f)));
  const BtfCaptureOptions options = small_capture({{0, 0}, {75, 180}}, {{30, 0}});
  const auto capture = [&](float albedo, const std::string& name) {
    Scene scene;
    scene.add_material({.material = lambert(albedo), .turned = lambert(0.5f)});
    scene.add_instance(
        scene.add_mesh(Mesh({.positions = flat.positions, .triangles = flat.triangles, .corner_normals = leaning})), {},
        {0});
    scene.commit(1);
    return Captured(scene, options, name);
  };
  const Captured dark = capture(0.2f, "dark"), bright = capture(0.5f, "bright");
  EXPECT_NEAR(dark.mean(0).mean / bright.mean(0).mean, 0.4, 1e-3) << "not mirrored below the face";
  EXPECT_NEAR(dark.mean(1).mean / bright.mean(1).mean, 1, 1e-3);
}

TEST(BtfCapture, BrokenMaterialsAreCountedAndCountAsNothing) {
  const Mesh flat = Corners().rectangle(0, 0, 1, 1).mesh();
  const auto scene = tile_of(flat, std::make_shared<test::BrokenLambert>(0.5f));
  const Captured captured(*scene, small_capture({{0, 0}}, {{0, 0}, {60, 0}, {60, 180}}), "broken");
  EXPECT_EQ(captured.report.warnings.size(), 1u);
  for (const float value : captured.values) EXPECT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace velour::btf_capture_test
