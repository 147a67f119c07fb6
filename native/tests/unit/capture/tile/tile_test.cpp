// What is asked for is what is made, or refused by name.
#include "capture/tile/tile.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"

namespace velour::tile_test {
namespace {

void expect_refused(const TileOptions& options, const std::string& word) {
  try {
    make_tile(options);
    ADD_FAILURE() << "taken, though " << word << " is wrong";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(Tile, TakesWhatIsSaidAndItsOwnForTheRest) {
  const Tile tile = make_tile({.kind = "weave", .size = 0.5, .gap = 0.3, .count = 2, .resolution = 8, .seed = 9});
  EXPECT_EQ(tile.period, Vec2(0.5f));
  EXPECT_EQ(tile.shape.gap, 0.3);
  EXPECT_EQ(tile.shape.pitch(), 0.25);
  EXPECT_EQ(tile.shape.seed, 9u);
  const TileShape own = tile_kinds()[0].defaults;
  EXPECT_EQ(tile.shape.thickness, own.thickness);
  EXPECT_EQ(tile.shape.irregularity, own.irregularity);
  EXPECT_EQ(tile.parts.mesh.triangles.size(), 2u * 2 * (2 * 8) * 8 * 2);
}

TEST(Tile, ChainMailOfALargerCountHasMoreRings) {
  const auto vertices = [](int count) {
    return make_tile({.kind = "chainmail", .count = count}).parts.mesh.positions.size();
  };
  EXPECT_EQ(vertices(6) * 4, vertices(4) * 9);
}

TEST(Tile, RefusesByName) {
  expect_refused({.kind = "felt"}, "felt");
  expect_refused({.kind = "felt"}, "chainmail");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double size : {0.0, -1.0, 1e9, nan}) expect_refused({.size = size}, "size");
  for (double thickness : {0.0, 3.0, nan}) expect_refused({.thickness = thickness}, "thickness");
  for (double gap : {0.0, 1.0, nan}) expect_refused({.gap = gap}, "gap");
  for (double irregularity : {-0.1, 1.1, nan}) expect_refused({.irregularity = irregularity}, "irregularity");
  for (int count : {0, 3, 100}) expect_refused({.count = count}, "count");
  expect_refused({.kind = "twill", .count = 6}, "multiple of 4");
  for (int resolution : {0, 7, 100000}) expect_refused({.resolution = resolution}, "resolution");
}

TEST(Tile, RefusesWhatAKindDoesNotHave) {
  expect_refused({.kind = "gravel", .gap = 0.1}, "gap");
  expect_refused({.kind = "chainmail", .irregularity = 0.1}, "irregularity");
}

}  // namespace
}  // namespace velour::tile_test
