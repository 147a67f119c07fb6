#include "compress/tensor_shape.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr double kViewsOfLights = 0.85;  // ratio of view to light ranks: shadows have sharper edges than masking

uint64_t texel_bytes(const TensorShape& shape, const TensorExtent& extent) {
  return uint64_t{shape.members} * (1 + shape.rank.texel) + (extent.relief ? sizeof(HalfBits) : 0);
}

/// Bytes of all clusters.
uint64_t cluster_bytes(const TensorShape& shape, const TensorExtent& extent) {
  const TensorSide::Ranks& r = shape.rank;
  const uint64_t core = uint64_t{r.texel} * r.view * r.light * r.color;
  const uint64_t factors = extent.views * r.view + extent.lights * r.light + 3 * uint64_t{r.color};
  return shape.clusters * ((core + factors) * sizeof(HalfBits) + r.texel * sizeof(ByteScale));
}

/// Sets the light rank to `lights`, and the view and texel ranks to match.
TensorShape with_lights(TensorShape shape, uint32_t lights, const TensorExtent& extent) {
  const auto views = static_cast<uint32_t>(std::lround(kViewsOfLights * lights));
  shape.rank.light = std::min(lights, extent.light_rank);
  shape.rank.view = std::clamp<uint32_t>(views, 1, extent.view_rank);
  shape.rank.texel = std::min(shape.rank.texel, shape.rank.view * shape.rank.light * shape.rank.color);
  return shape;
}

}  // namespace

uint64_t tensor_bytes(const TensorShape& shape, const TensorExtent& extent) {
  return extent.texels * texel_bytes(shape, extent) + cluster_bytes(shape, extent);
}

std::optional<TensorShape> largest_shape(const ShapeChoice& choice, const TensorExtent& extent, uint64_t bytes) {
  TensorShape shape{choice.clusters, choice.members, {1, 1, 1, choice.colors}};
  const double a_texel = choice.texel_share * static_cast<double>(bytes) / static_cast<double>(extent.texels);
  const double rank = std::floor((a_texel - (extent.relief ? 2.0 : 0.0)) / choice.members) - 1;
  const auto most = static_cast<double>(std::min<uint64_t>({TensorBtf::kMaxRank, extent.functions / choice.clusters,
                                                            (extent.finest + choice.clusters - 1) / choice.clusters}));
  if (rank < 1 || most < 1) return std::nullopt;
  shape.rank.texel = static_cast<uint32_t>(std::min(rank, most));
  std::optional<TensorShape> found;
  for (uint32_t lights = 1; lights <= std::max(extent.light_rank, 2 * extent.view_rank); ++lights) {
    const TensorShape larger = with_lights(shape, lights, extent);
    if (tensor_bytes(larger, extent) > bytes) break;
    found = larger;
  }
  return found;
}

}  // namespace velour
