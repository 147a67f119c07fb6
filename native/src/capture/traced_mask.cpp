#include "capture/traced_mask.h"

namespace velour {

std::vector<uint8_t> traced_mask(const RepeatedTile& tile, const TileTexels& texels, float reference, const Vec3& wv,
                                 RayLog* log) {
  const Vec2 aside = Vec2(wv) / wv.z * (tile.top() - reference);
  const float above = tile.top() + 1e-4f * tile.period().x;
  TileRays rays(tile);
  std::vector<Ray> row(texels.width);
  std::vector<Hit> hits(texels.width);
  std::vector<uint8_t> mask;
  for (uint32_t y = 0; y < texels.height; ++y) {
    for (uint32_t x = 0; x < texels.width; ++x) {
      row[x] = {Vec3(tile.into_cell(tile.period().x * texels.centre(x, y) + aside), above), 0, -wv};
    }
    rays.intersect(row, hits, log);
    for (const Hit& hit : hits) mask.push_back(hit.instance != kNoHit ? 1 : 0);
  }
  return mask;
}

}  // namespace velour
