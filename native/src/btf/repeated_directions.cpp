#include "btf/repeated_directions.h"

#include <algorithm>

namespace velour {
namespace {

/// Well below any spacing in use, well above the rounding error of angles.
constexpr float kSame = 1e-5f;  // radians

size_t repeated(const std::vector<PolarAngles>& set) {
  std::vector<Vec3> known;
  for (const PolarAngles& angles : set) {
    const Vec3 d = unit_direction(angles);
    if (std::ranges::none_of(known, [&](const Vec3& k) { return glm::distance(k, d) < kSame; })) known.push_back(d);
  }
  return set.size() - known.size();
}

}  // namespace

std::string repeated_directions(const PairLayout& layout) {
  const size_t views = repeated(layout.views()), lights = repeated(layout.lights());
  if (views == 0 && lights == 0) return "";
  return "The BTF contains the same direction under different angles (phi 0 and 360, or any phi at theta 0): " +
         std::to_string(views) + " of its views and " + std::to_string(lights) +
         " of its lights repeat an earlier one. Interpolation uses only the earlier one.";
}

}  // namespace velour
