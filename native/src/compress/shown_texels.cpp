#include "compress/shown_texels.h"

#include "compress/surface_points.h"
#include "compress/texel_pieces.h"
#include "job/parallel.h"

namespace velour {
namespace {

ShownTexel shown_texel(const Relief& relief, uint32_t texel, const Vec3& wv, float aspect) {
  if (is_plane(relief)) return {{{texel, texel, texel, texel}, {1, 0, 0, 0}}, true};
  const uint32_t x = texel % relief.width(), y = texel / relief.width();
  const Vec2 place = (Vec2(x, y) + 0.5f) / Vec2(relief.width(), relief.height());
  const std::optional<Vec2> at = shown_at(relief, place, relief.height_of(x, y), aspect, wv);
  return {bilinear_texels(at.value_or(place), relief.width(), relief.height()), at.has_value()};
}

}  // namespace

std::vector<ShownTexel> shown_texels(const Relief& relief, const std::vector<uint32_t>& texels, const Vec3& wv,
                                     float aspect, int threads, const Progress& progress) {
  std::vector<ShownTexel> shown(texels.size());
  parallel_pieces((texels.size() + kTexelsPerPiece - 1) / kTexelsPerPiece, threads, progress, [&](size_t piece) {
    const size_t end = std::min(texels.size(), (piece + 1) * kTexelsPerPiece);
    for (size_t i = piece * kTexelsPerPiece; i < end; ++i) shown[i] = shown_texel(relief, texels[i], wv, aspect);
  });
  return shown;
}

}  // namespace velour
