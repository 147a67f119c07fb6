#include "btf/direction_sets.h"

#include <algorithm>
#include <charconv>

#include "btf/btf_measurement.h"
#include "job/error.h"

namespace velour {
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

}  // namespace velour
