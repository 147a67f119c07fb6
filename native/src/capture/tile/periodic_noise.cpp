#include "capture/tile/periodic_noise.h"

#include "math/sphere/random.h"

namespace velour {

namespace {

double smooth(double t) { return t * t * (3 - 2 * t); }

int wrapped(int i, int n) { return ((i % n) + n) % n; }

}  // namespace

double PeriodicNoise::operator()(const glm::dvec2& at) const {
  const glm::dvec2 place = at * glm::dvec2(cells), corner = glm::floor(place), rest = place - corner;
  const auto value = [&](int dx, int dy) {
    const int x = wrapped(int(corner.x) + dx, cells.x), y = wrapped(int(corner.y) + dy, cells.y);
    return double(
        RandomStream(seed, stream, static_cast<uint64_t>(y) * static_cast<uint64_t>(cells.x) + static_cast<uint64_t>(x))
            .next());
  };
  const double u = smooth(rest.x), v = smooth(rest.y);
  return glm::mix(glm::mix(value(0, 0), value(1, 0), u), glm::mix(value(0, 1), value(1, 1), u), v);
}

}  // namespace velour
