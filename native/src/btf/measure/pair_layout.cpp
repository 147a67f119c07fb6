#include "btf/measure/pair_layout.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "base/error.h"
#include "btf/measure/btf_measurement.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

constexpr double kMinElevation = 0.1;  // degrees from the plane; smaller cosines are not worth dividing by

std::string text_of(const PolarAngles& angles) {
  return "theta " + std::to_string(angles.theta) + ", phi " + std::to_string(angles.phi);
}

void check_directions(const std::vector<PolarAngles>& set, const std::string& what) {
  const auto refuse = [&](const std::string& sentence) { throw Error(Status::invalid_argument, sentence); };
  if (set.empty()) refuse("A BTF needs at least one " + what + " direction.");
  for (const PolarAngles& d : set) {
    const bool inside = std::isfinite(d.phi) && d.theta >= 0 && d.theta <= 180;  // false for NaN
    if (!inside || std::abs(d.theta - 90.0) < kMinElevation) {
      refuse("The " + what + " direction " + text_of(d) +
             " degrees is invalid: theta must be between 0 and 180 degrees and differ from 90 by at least 0.1.");
    }
  }
  std::vector<PolarAngles> sorted = set;
  const auto order = [](const PolarAngles& a, const PolarAngles& b) {
    return a.theta != b.theta ? a.theta < b.theta : a.phi < b.phi;
  };
  std::sort(sorted.begin(), sorted.end(), order);
  const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
  if (twin != sorted.end())
    refuse("The " + what + " direction " + text_of(*twin) + " degrees occurs more than once; remove one.");
}

std::vector<std::vector<uint32_t>> all_lights(size_t views, size_t lights) {
  std::vector<uint32_t> every(lights);
  for (size_t i = 0; i < lights; ++i) every[i] = static_cast<uint32_t>(i);
  return std::vector(views, every);
}

}  // namespace

PairLayout::PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights)
    : PairLayout(views, lights, all_lights(views.size(), lights.size())) {}

PairLayout::PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights,
                       const std::vector<std::vector<uint32_t>>& lights_of_view)
    : views_(std::move(views)), lights_(std::move(lights)), first_{0} {
  check_directions(views_, "view");
  check_directions(lights_, "light");
  for (const std::vector<uint32_t>& of_view : lights_of_view) {
    light_of_pair_.insert(light_of_pair_.end(), of_view.begin(), of_view.end());
    first_.push_back(light_of_pair_.size());
  }
  check();
}

void PairLayout::check() const {
  const auto refuse = [](const char* sentence) { throw Error(Status::invalid_argument, sentence); };
  if (first_.size() != views_.size() + 1) refuse("A BTF must have one list of lights per view.");
  if (pairs() == 0) refuse("A BTF must have at least one view-light pair.");
  for (size_t v = 0; v < views_.size(); ++v) {
    for (uint64_t p = first(v); p < first(v + 1); ++p) {
      if (light_of_pair_[p] >= lights_.size()) refuse("A view of a BTF has a light index that does not exist.");
      if (p > first(v) && light_of_pair_[p] <= light_of_pair_[p - 1])
        refuse("The light indices of each view of a BTF must increase.");
    }
  }
}

uint32_t PairLayout::view_of(uint64_t pair) const {
  const auto after = std::upper_bound(first_.begin(), first_.end(), pair);
  return static_cast<uint32_t>(after - first_.begin() - 1);
}

DirectionPair PairLayout::directions(uint64_t pair) const {
  return {unit_direction(lights_[light_of(pair)]), unit_direction(views_[view_of(pair)])};
}

namespace {

constexpr double kMaxTheta = 89.89;  // degrees; PairLayout rejects directions closer to the plane

}  // namespace

std::vector<PolarAngles> named_directions(const std::string& name) {
  if (name == "81") return bonn_directions();
  if (name == "105") return capture_directions();
  int count = 0;
  const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), count);
  const bool whole = problem == std::errc() && end == name.data() + name.size();
  if (!whole || count < 1 || count > static_cast<int>(kMaxDirections)) {
    throw Error(Status::invalid_argument, "Unknown direction set '" + name +
                                              "'; use 81, 105, or a number of directions from 1 to " +
                                              std::to_string(kMaxDirections) + ".");
  }
  std::vector<PolarAngles> set = even_directions(count);
  for (PolarAngles& d : set) d.theta = std::min(d.theta, kMaxTheta);
  return set;
}

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

std::optional<Warning> repeated_directions(const PairLayout& layout) {
  const size_t views = repeated(layout.views()), lights = repeated(layout.lights());
  if (views == 0 && lights == 0) return std::nullopt;
  return warning<WarningCode::repeated_directions>({{"views", views}, {"lights", lights}});
}

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
