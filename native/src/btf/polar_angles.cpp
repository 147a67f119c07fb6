#include "btf/polar_angles.h"

#include <cmath>

#include "sphere/directions.h"

namespace velour {
namespace {

struct SineCosine {
  double sine, cosine;
};

/// Exact at multiples of 90 degrees.
SineCosine of_degrees(double degrees) {
  const double turn = degrees - 360.0 * std::floor(degrees / 360.0);
  const double quarters = std::nearbyint(turn / 90.0);
  const double rest = radians_from(turn - 90.0 * quarters);  // within 45 degrees of 0
  const double s = std::sin(rest), c = std::cos(rest);
  switch (static_cast<int>(quarters) % 4) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double degrees_from(double radians) { return radians * (180.0 / kPiD); }

}  // namespace

Vec3 unit_direction(const PolarAngles& angles) {
  const SineCosine theta = of_degrees(angles.theta), phi = of_degrees(angles.phi);
  return Vec3(Vec3d(theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine));
}

std::vector<PolarAngles> ring_directions(double theta, int count) {
  std::vector<PolarAngles> ring;
  for (int i = 0; i < count; ++i) ring.push_back({theta, 360.0 * i / count});
  return ring;
}

std::vector<PolarAngles> bonn_directions() {
  std::vector<PolarAngles> set;
  int ring = 0;
  for (const int count : {1, 6, 12, 18, 20, 24}) {
    const std::vector<PolarAngles> directions = ring_directions(15.0 * ring++, count);
    set.insert(set.end(), directions.begin(), directions.end());
  }
  return set;
}

std::vector<PolarAngles> capture_directions() {
  std::vector<PolarAngles> set = bonn_directions();
  const std::vector<PolarAngles> last = ring_directions(85.0, 24);
  set.insert(set.end(), last.begin(), last.end());
  return set;
}

std::vector<PolarAngles> even_directions(int count) {
  std::vector<PolarAngles> set;
  for (const Vec3& d : hemisphere_fibonacci(count)) {
    const double phi = degrees_from(std::atan2(static_cast<double>(d.y), static_cast<double>(d.x)));
    set.push_back({degrees_from(std::acos(std::min(1.0, static_cast<double>(d.z)))), phi < 0 ? phi + 360.0 : phi});
  }
  return set;
}

std::vector<PolarAngles> below(const std::vector<PolarAngles>& directions) {
  std::vector<PolarAngles> set = directions;
  for (PolarAngles& d : set) d.theta = 180.0 - d.theta;
  return set;
}

std::vector<Vec3> directions_on_side(const std::vector<PolarAngles>& set, bool below) {
  std::vector<Vec3> directions;
  for (const PolarAngles& d : set) {
    const Vec3 w = unit_direction(d);
    if ((w.z < 0) == below) directions.emplace_back(w.x, w.y, std::abs(w.z));
  }
  return directions;
}

}  // namespace velour
