#include "tile/packing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sphere/random.h"

namespace velour {
namespace {

constexpr uint64_t kStream = 0x6261;
constexpr int kPlacesTried = 400;

/// Height of the center at which a ball falling straight down comes to rest.
double resting_height(const std::vector<Ball>& balls, const Ball& falling, double period) {
  double height = falling.radius;
  for (const Ball& other : balls) {
    const Vec3d d = periodic_difference(falling.center, other.center, period);
    const double reach = falling.radius + other.radius, room = reach * reach - d.x * d.x - d.y * d.y;
    if (room > 0) height = std::max(height, other.center.z + std::sqrt(room));
  }
  return height;
}

}  // namespace

Vec3d periodic_difference(const Vec3d& a, const Vec3d& b, double period) {
  Vec3d d = b - a;
  d.x -= period * std::round(d.x / period);
  d.y -= period * std::round(d.y / period);
  return d;
}

std::vector<Ball> pack_balls(const PackingOptions& options) {
  std::vector<Ball> balls;
  double volume = 0;
  while (volume < options.volume) {
    RandomStream random(options.seed, kStream, balls.size());
    const double radius = glm::mix(options.smallest_radius, options.largest_radius, double(random.next()));
    Ball best{.center = Vec3d(0, 0, std::numeric_limits<double>::infinity()), .radius = radius};
    for (int i = 0; i < kPlacesTried; ++i) {
      const Vec2 u = random.next2();
      Ball ball{.center = Vec3d(options.period * u.x, options.period * u.y, 0), .radius = radius};
      ball.center.z = resting_height(balls, ball, options.period);
      if (ball.center.z < best.center.z) best = ball;
    }
    balls.push_back(best);
    volume += 4.0 / 3.0 * kPiD * radius * radius * radius;
  }
  return balls;
}

}  // namespace velour
