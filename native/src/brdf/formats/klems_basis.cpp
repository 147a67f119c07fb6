#include "brdf/formats/klems_basis.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace velour {
namespace {

using Ring = KlemsBasis::Ring;

/// The two patches of a ring of `patches` around an azimuth, with weights that add up to `weight`.
void along_ring(uint32_t first, uint32_t patches, float azimuth, float weight, KlemsBasis::Weighed* out) {
  const float place = azimuth / (2 * kPi) * static_cast<float>(patches);
  const float below = std::floor(place), share = place - below;
  const auto lower = static_cast<uint32_t>(below) % patches;
  out[0] = {first + lower, weight * (1 - share)};
  out[1] = {first + (lower + 1) % patches, weight * share};
}

}  // namespace

KlemsBasis::KlemsBasis(const std::vector<Ring>& rings) {
  for (const Ring& ring : rings) {
    const bool is_cap = ring.least_theta == 0 && ring.patches == 1;  // its center is the normal
    const double center = is_cap ? 0.0 : (ring.least_theta + ring.most_theta) / 2;
    rings_.push_back({static_cast<float>(radians_from(center)), patches_, ring.patches});
    patches_ += ring.patches;
  }
}

const KlemsBasis* KlemsBasis::standard(const std::string& name) {
  static const std::pair<const char*, KlemsBasis> kBases[] = {
      {"LBNL/Klems Full", KlemsBasis({{0, 5, 1},
                                      {5, 15, 8},
                                      {15, 25, 16},
                                      {25, 35, 20},
                                      {35, 45, 24},
                                      {45, 55, 24},
                                      {55, 65, 24},
                                      {65, 75, 16},
                                      {75, 90, 12}})},
      {"LBNL/Klems Half", KlemsBasis({{0, 6.5, 1},
                                      {6.5, 19.5, 8},
                                      {19.5, 32.5, 12},
                                      {32.5, 46.5, 16},
                                      {46.5, 61.5, 20},
                                      {61.5, 76.5, 12},
                                      {76.5, 90, 4}})},
      {"LBNL/Klems Quarter", KlemsBasis({{0, 9, 1}, {9, 27, 8}, {27, 46, 12}, {46, 66, 12}, {66, 90, 8}})}};
  for (const auto& [known, basis] : kBases) {
    if (name == known) return &basis;
  }
  return nullptr;
}

std::array<KlemsBasis::Weighed, 4> KlemsBasis::around(const Vec3& w) const {
  const float theta = std::acos(std::clamp(w.z, -1.0f, 1.0f));
  float azimuth = std::atan2(w.y, w.x);
  if (azimuth < 0) azimuth += 2 * kPi;
  const auto above = std::upper_bound(rings_.begin(), rings_.end(), theta,
                                      [](float angle, const Placed& ring) { return angle < ring.center; });
  const Placed& lower = above == rings_.begin() ? *above : *std::prev(above);
  const Placed& upper = above == rings_.end() ? lower : *above;
  const float gap = upper.center - lower.center;
  const float share = gap > 0 ? std::clamp((theta - lower.center) / gap, 0.0f, 1.0f) : 0.0f;
  std::array<Weighed, 4> found;
  along_ring(lower.first, lower.patches, azimuth, 1 - share, &found[0]);
  along_ring(upper.first, upper.patches, azimuth, share, &found[2]);
  return found;
}

}  // namespace velour
