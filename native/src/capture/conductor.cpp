#include "capture/conductor.h"

#include <algorithm>

#include "capture/microsurface.h"
#include "job/error.h"

namespace velour {
namespace {

struct NamedConductor {
  const char* name;
  Conductor conductor;
};

// Nickel, iron, chromium, titanium: Johnson and Christy, Phys. Rev. B 9, 5056 (1974). Gold, copper, silver: Johnson and
// Christy, Phys. Rev. B 6, 4370 (1972). Aluminium: Rakic, Appl. Opt. 34, 4755 (1995), interpolated linearly between
// rows. All as tabulated by refractiveindex.info (public domain).
constexpr NamedConductor kMetals[] = {
    {"nickel", {{1.99f, 1.92f, 1.78f}, {4.02f, 3.61f, 3.09f}}},
    {"gold", {{0.21f, 0.43f, 1.31f}, {3.272f, 2.455f, 1.849f}}},
    {"copper", {{0.30f, 1.02f, 1.25f}, {3.205f, 2.577f, 2.483f}}},
    {"aluminium", {{1.350f, 1.009f, 0.709f}, {7.371f, 6.611f, 5.712f}}},
    {"silver", {{0.06f, 0.06f, 0.05f}, {4.152f, 3.586f, 2.869f}}},
    {"iron", {{2.88f, 2.95f, 2.67f}, {3.05f, 2.93f, 2.82f}}},
    {"chromium", {{3.17f, 3.18f, 2.51f}, {3.30f, 3.33f, 3.24f}}},
    {"titanium", {{2.67f, 2.54f, 2.32f}, {3.72f, 3.43f, 3.10f}}},
};

}  // namespace

Rgb fresnel_reflectance(const Conductor& conductor, float cos_theta) {
  const float cos_sq = cos_theta * cos_theta, sin_sq = 1.0f - cos_sq;
  const Rgb n_sq = conductor.n * conductor.n, k_sq = conductor.k * conductor.k;
  // a^2 + b^2 and a of the complex cosine (a + i b) inside the metal, times its index.
  const Rgb t = n_sq - k_sq - sin_sq;
  const Rgb modulus = glm::sqrt(t * t + 4.0f * n_sq * k_sq);
  const Rgb two_a_cos = 2.0f * cos_theta * glm::sqrt(glm::max(0.5f * (modulus + t), Rgb(0)));
  const Rgb perpendicular = (modulus + cos_sq - two_a_cos) / (modulus + cos_sq + two_a_cos);
  const Rgb along = modulus * cos_sq + sin_sq * sin_sq, cross = two_a_cos * sin_sq;
  return 0.5f * perpendicular * (1.0f + (along - cross) / (along + cross));
}

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const NamedConductor& m : kMetals) names.push_back(m.name);
  return names;
}

Conductor metal(const std::string& name) {
  for (const NamedConductor& m : kMetals) {
    if (name == m.name) return m.conductor;
  }
  std::string known;
  for (const std::string& n : metal_names()) known += (known.empty() ? "" : ", ") + n;
  throw Error(Status::invalid_argument, "Metal \"" + name + "\" is not known: take one of " + known + ".");
}

}  // namespace velour
