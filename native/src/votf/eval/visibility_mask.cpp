#include "votf/eval/visibility_mask.h"

#include <cmath>

#include "math/sphere/random.h"
#include "votf/eval/shell_trace.h"

namespace velour {

Vec3 check_view(uint64_t seed, uint32_t i) {
  RandomStream numbers(seed, i, 0);
  const float cosine = 1 - numbers.next() * (1 - std::cos(radians_from(75.0f)));
  return direction(std::acos(cosine), 2 * kPi * numbers.next());
}

std::vector<uint8_t> visibility_mask(const ShellField& field, const TileTexels& texels, const Vec3& wv) {
  std::vector<Vec2> places(texels.size());
  for (size_t i = 0; i < places.size(); ++i) places[i] = texels.center(i);
  std::vector<uint8_t> mask(places.size());
  lines_meet(field, places, wv, mask.data());
  return mask;
}

}  // namespace velour
