#include "capture/occlusion_capture.h"

#include <gtest/gtest.h>

#include "support/captured.h"
#include "support/materials.h"
#include "tile/tile.h"

namespace velour {
namespace {

std::unique_ptr<Scene> scene_of(const std::string& kind) {
  const Tile tile = make_tile({.kind = kind});
  const TileMesh& m = tile.parts.mesh;
  return test::tile_of(Mesh({.positions = m.positions, .triangles = m.triangles, .corner_normals = m.corner_normals}),
                       std::make_shared<test::Lambert>(0.5f));
}

OcclusionCapture captured(const std::string& kind, uint32_t texels) {
  const Tile tile = make_tile({.kind = kind});
  Progress progress;
  OcclusionCaptureOptions options;
  options.place.period = tile.period;
  options.texels = texels;
  options.reference_height = 0;
  options.check_views = 16;
  return capture_occlusion(*scene_of(kind), options, progress);
}

class OfTiles : public ::testing::TestWithParam<const char*> {};

TEST_P(OfTiles, SeesWhatRaysSee) {
  const OcclusionCapture c = captured(GetParam(), 128);
  printf("%s: %u x %u x %u = %zu bytes, coverage %.4f wrong %.5f, %.2f s, closed %d\n", GetParam(), c.volume.width,
         c.volume.height, c.volume.depth, c.volume.distance.size(), c.errors->coverage, c.errors->wrong, c.seconds,
         c.volume.closed);
  for (const auto& w : c.warnings) printf("  %s\n", w.c_str());
  EXPECT_LT(c.errors->wrong, 0.01);
}

INSTANTIATE_TEST_SUITE_P(OcclusionCapture, OfTiles,
                         ::testing::Values("net", "chainmail", "weave", "twill", "gravel", "corduroy"));

}  // namespace
}  // namespace velour
