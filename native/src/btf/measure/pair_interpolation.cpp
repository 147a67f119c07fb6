#include "btf/measure/pair_interpolation.h"

#include <string>

#include "base/error.h"

namespace velour {

PairInterpolation::Sides::Sides(const std::vector<PolarAngles>& directions) {
  std::array<std::vector<Vec3>, 2> of_side;
  for (uint32_t i = 0; i < directions.size(); ++i) {
    const Vec3 d = unit_direction(directions[i]);
    const size_t side = d.z > 0 ? 0 : 1;
    of_side[side].emplace_back(d.x, d.y, std::abs(d.z));
    number[side].push_back(i);
  }
  for (size_t side = 0; side < 2; ++side) {
    if (!of_side[side].empty()) mesh[side].emplace(of_side[side]);
  }
}

std::optional<DirectionMesh::Weights> PairInterpolation::Sides::at(const Vec3& d) const {
  const size_t side = d.z >= 0 ? 0 : 1;
  if (!mesh[side]) return std::nullopt;
  Corners corners = mesh[side]->at({d.x, d.y, std::abs(d.z)});
  for (uint32_t& index : corners.index) index = number[side][index];
  return corners;
}

PairInterpolation::PairInterpolation(const PairLayout& layout) : views_(layout.views()), lights_(layout.lights()) {
  if (layout.complete()) return;
  throw Error(Status::unsupported, "The BTF has " + std::to_string(layout.pairs()) + " of " +
                                       std::to_string(layout.views().size() * layout.lights().size()) +
                                       " view-light pairs; interpolation requires all of them.");
}

}  // namespace velour
