#include "brdf/azimuth_spread.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "brdf/half_diff.h"

namespace velour {
namespace {

constexpr float kCell = radians_from(3.0f);
constexpr float kAlike = radians_from(15.0f), kTurned = radians_from(30.0f);
constexpr float kUpright = radians_from(5.0f);  // minimum polar angle of a half vector with a meaningful azimuth
constexpr size_t kFewest = 100;
constexpr size_t kMostInCell = 64;  // the number of pairs grows with the square

struct Entry {
  uint64_t cell;
  float phi_h;  // modulo half a turn
  float log_f;
};

uint64_t cell_of(const HalfDiff& angles) {
  const auto part = [](float angle) { return static_cast<uint64_t>(angle / kCell); };
  return (part(angles.theta_h) * 64 + part(angles.theta_d)) * 64 + part(angles.phi_d);
}

/// Smallest angle between two azimuths modulo half a turn.
float between(float a, float b) {
  const float apart = std::fmod(std::abs(a - b), kPi);
  return std::min(apart, kPi - apart);
}

double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return double{*middle};
}

}  // namespace

std::optional<AzimuthSpread> azimuth_spread(std::span<const ScatteredSample> samples) {
  std::vector<Entry> entries;
  for (const ScatteredSample& s : samples) {
    const HalfDiff angles = half_diff(s.wl, s.wv);
    const float f = luminance(s.f);
    if (angles.theta_h < kUpright || !(f > 0.0f)) continue;
    entries.push_back({cell_of(angles), angles.phi_h, std::log(f)});
  }
  std::ranges::stable_sort(entries, {}, &Entry::cell);
  std::vector<float> alike, turned;
  for (size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].cell == entries[begin].cell) ++end;
    const size_t last = std::min(end, begin + kMostInCell);
    for (size_t i = begin; i < last; ++i)
      for (size_t j = i + 1; j < last; ++j) {
        const Entry &a = entries[i], &b = entries[j];
        const float difference = std::abs(a.log_f - b.log_f), apart = between(a.phi_h, b.phi_h);
        if (apart <= kAlike) alike.push_back(difference);
        if (apart >= kTurned) turned.push_back(difference);
      }
  }
  if (alike.size() < kFewest || turned.size() < kFewest) return std::nullopt;
  return AzimuthSpread{median(alike), median(turned), turned.size()};
}

}  // namespace velour
