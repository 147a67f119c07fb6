#include "realtime/maps.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/example_shell.h"
#include "votf/eval/occlusion_volume.h"

namespace velour::shell_maps_test {
namespace {

/// Pixel of a point of the volume, or of the border around it.
const float* pixel(const TablePixels& maps, const VotfVolume& volume, uint32_t x, uint32_t y, uint32_t z) {
  return maps.at(x + 1, z * (volume.height + 2) + y + 1);
}

TEST(ShellMaps, HoldDistancesAndTheirSlopes) {
  const auto volume = test::wires(16, 0.2f);
  const TablePixels maps = shell_maps(*volume);
  ASSERT_EQ(maps.width, 18u);
  ASSERT_EQ(maps.height, 18u * volume->depth);
  const ShellField field(volume);
  for (uint32_t z = 0; z < volume->depth; ++z) {
    for (uint32_t x = 0; x < volume->width; ++x) {
      const Vec3 at((static_cast<float>(x) + 0.5f) * volume->pitch(), 0.3125f - 0.5f * volume->pitch(),
                    volume->bottom + static_cast<float>(z) * volume->step());
      const float* const found = pixel(maps, *volume, x, 4, z);
      EXPECT_NEAR(found[0], field.distance(at), 1e-5f);
      EXPECT_NEAR(found[2], 0, 1e-5f);
      if (z == 0 || z + 1 == volume->depth) continue;
      const Vec3 slope = field.gradient(at);
      EXPECT_NEAR(found[1], slope.x, 1e-3f);
      EXPECT_NEAR(found[3], slope.z, 0.05f);  // over a step, where the field's is over a pitch
    }
  }
}

TEST(ShellMaps, BordersRepeatTheTile) {
  const auto volume = test::shell_of(8, 0, 0.25f, [](const Vec3& p) { return p.z - 0.1f * p.x - 0.05f * p.y; });
  const TablePixels maps = shell_maps(*volume);
  for (uint32_t z = 0; z < volume->depth; ++z) {
    const uint32_t row = z * 10;
    for (uint32_t i = 1; i < 9; ++i) {
      for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(maps.at(0, row + i)[c], maps.at(8, row + i)[c]);
        EXPECT_EQ(maps.at(9, row + i)[c], maps.at(1, row + i)[c]);
        EXPECT_EQ(maps.at(i, row)[c], maps.at(i, row + 8)[c]);
        EXPECT_EQ(maps.at(i, row + 9)[c], maps.at(i, row + 1)[c]);
      }
    }
  }
}

TEST(ShellMaps, OfTooManyPointsAreRefused) {
  VotfVolume volume;
  volume.width = volume.height = 4096;
  volume.depth = 2;
  EXPECT_THROW(shell_maps(volume), Error);
}

}  // namespace
}  // namespace velour::shell_maps_test
