#include "votf/visibility_mask.h"

#include <cmath>

#include "sphere/random.h"
#include "votf/shell_trace.h"

namespace velour {

Vec3 check_view(uint64_t seed, uint32_t i) {
  RandomStream numbers(seed, i, 0);
  const float cosine = 1 - numbers.next() * (1 - std::cos(radians_from(75.0f)));
  return direction(std::acos(cosine), 2 * kPi * numbers.next());
}

std::vector<uint8_t> visibility_mask(const ShellField& field, const TileTexels& texels, const Vec3& wv) {
  std::vector<uint8_t> mask(texels.size());
  for (size_t i = 0; i < mask.size(); ++i) mask[i] = line_meets(field, texels.centre(i), wv) ? 1 : 0;
  return mask;
}

}  // namespace velour
