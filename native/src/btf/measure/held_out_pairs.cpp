#include "btf/measure/held_out_pairs.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "btf/measure/btf_measurement.h"
#include "math/sphere/random.h"

namespace velour {
namespace {

constexpr uint64_t kSeed = 75;           // arbitrary, but fixed so that results stay comparable
constexpr double kMaxHeldOutTheta = 75;  // degrees

PolarAngles drawn_direction(RandomStream& random, bool two_sided) {
  const double least_cosine = std::cos(radians_from(kMaxHeldOutTheta));
  const double cosine = 1 - static_cast<double>(random.next()) * (1 - least_cosine);
  const double theta = std::acos(cosine) * (180 / kPiD), phi = 360 * static_cast<double>(random.next());
  const bool below = random.next() < 0.5f;
  return {two_sided && below ? 180 - theta : theta, phi};
}

}  // namespace

PairLayout held_out_pairs(uint32_t count, bool two_sided) {
  if (count < 1 || count > kMaxDirections) {
    throw Error(Status::invalid_argument, "The number of held-out pairs is " + std::to_string(count) +
                                              "; it must be 1 to " + std::to_string(kMaxDirections) + ".");
  }
  std::vector<PolarAngles> views, lights;
  std::vector<std::vector<uint32_t>> light_of_view;
  for (uint32_t i = 0; i < count; ++i) {
    RandomStream random(kSeed, 0, i);
    views.push_back(drawn_direction(random, two_sided));
    lights.push_back(drawn_direction(random, two_sided));
    light_of_view.push_back({i});
  }
  return {std::move(views), std::move(lights), light_of_view};
}

}  // namespace velour
