#include "render/path_numbers.h"

#include <cmath>

#include "render/lattice.h"
#include "sphere/sobol.h"

namespace velour {

void PathNumbers::points(Purpose purpose, uint32_t first, std::span<Vec2> u) {
  if (u.empty()) return;
  if (sequence_ == Sequence::sobol) return sobol_points(key(purpose), first, u);
  const Vec2 shift = random_.next2();
  const int n = static_cast<int>(u.size());
  for (int i = 0; i < n; ++i) u[static_cast<size_t>(i)] = lattice_point(i, n, shift);
}

Vec2 PathNumbers::point(Purpose purpose) {
  Vec2 u;
  points(purpose, ray_, {&u, 1});
  return u;
}

PathNumbers::Sides PathNumbers::deal(int directions, int full, float light_share) {
  const double share = static_cast<double>(light_share);
  if (sequence_ == Sequence::random) {
    const double exact = directions * share, whole = std::floor(exact);
    const bool one_more = whole < exact && static_cast<double>(random_.next()) < exact - whole;
    const int light = static_cast<int>(whole) + (one_more ? 1 : 0);
    return {{0, directions - light}, {0, light}};
  }
  // Systematic sampling: direction number d goes to the lights where floor(d share + offset) takes a step. Whatever the
  // share, a side's directions are successive points of its sequence.
  const double offset = static_cast<double>(unit_float(key(Purpose::side)));
  const uint32_t first = ray_ * static_cast<uint32_t>(full);
  const auto lights_before = [&](double d) { return static_cast<uint32_t>(std::floor(d * share + offset)); };
  const uint32_t before = lights_before(first), after = lights_before(static_cast<double>(first) + directions);
  const int light = static_cast<int>(after - before);
  return {{first - before, directions - light}, {before, light}};
}

}  // namespace velour
