#include "btf/pair_layout.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "job/error.h"

namespace velour {
namespace {

constexpr double kLeastElevation = 0.1;  // degrees from the plane; smaller cosines are not worth dividing by

std::string text_of(const PolarAngles& angles) {
  return "theta " + std::to_string(angles.theta) + ", phi " + std::to_string(angles.phi);
}

void check_directions(const std::vector<PolarAngles>& set, const std::string& what) {
  const auto refuse = [&](const std::string& sentence) { throw Error(Status::invalid_argument, sentence); };
  if (set.empty()) refuse("A BTF needs at least one " + what + " direction.");
  for (const PolarAngles& d : set) {
    const bool inside = std::isfinite(d.phi) && d.theta >= 0 && d.theta <= 180;  // false for NaN
    if (!inside || std::abs(d.theta - 90.0) < kLeastElevation) {
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

}  // namespace velour
