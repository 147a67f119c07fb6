#include "render/path/path_numbers.h"

#include <cmath>

#include "math/sphere/random.h"

namespace velour {

void PathNumbers::points(Purpose purpose, uint32_t first, std::span<Vec2> u) {
  if (u.empty()) return;
  if (sequence_ == Sequence::sobol) return sobol_points(key(purpose), first, u);
  if (sequence_ == Sequence::independent) {
    for (Vec2& point : u) point = random_.next2();
    return;
  }
  const Vec2 shift = random_.next2();
  const int n = static_cast<int>(u.size());
  for (int i = 0; i < n; ++i) u[static_cast<size_t>(i)] = lattice_point(i, n, shift);
}

void PathNumbers::points(Purpose purpose, uint32_t first, int count, PointBatch& batch) {
  if (sequence_ == Sequence::sobol) return batch.add(SobolSeeds(key(purpose)), first, count);
  points(purpose, first, batch.add(count));
}

Vec2 PathNumbers::point(Purpose purpose) {
  Vec2 u;
  points(purpose, ray_, {&u, 1});
  return u;
}

RayDecisions PathNumbers::decisions() {
  if (sequence_ != Sequence::sobol) return {random_.next_bits(), 0};
  return {mix64(~key(Purpose::camera)), ray_};
}

void PathNumbers::time(PointBatch& batch) {
  if (sequence_ == Sequence::sobol) return batch.add(SobolSeeds(mix64(~key(Purpose::side))), ray_, 1);
  point(Purpose::side, batch);
}

float PathNumbers::label() {
  if (sequence_ != Sequence::sobol) return random_.next();
  Vec2 u;
  sobol_points(mix64(~key(Purpose::continuation)), ray_, {&u, 1});
  return u.x;
}

float PathNumbers::lobe() {
  if (sequence_ != Sequence::sobol) return random_.next();
  Vec2 u;
  sobol_points(mix64(~key(Purpose::product_side)), ray_, {&u, 1});
  return u.x;
}

PathNumbers::Deal PathNumbers::deal(Run run, float share, Purpose purpose) {
  const double part = static_cast<double>(share);
  if (sequence_ != Sequence::sobol) {
    const double exact = run.count * part, whole = std::floor(exact);
    const bool one_more = whole < exact && static_cast<double>(random_.next()) < exact - whole;
    const int dealt = static_cast<int>(whole) + (one_more ? 1 : 0);
    return {{0, run.count - dealt}, {0, dealt}};
  }
  // Systematic sampling: direction d is dealt out where floor(d share + offset) takes a step. For any share, the
  // directions of each part are successive points of its sequence.
  const double offset = static_cast<double>(unit_float(key(purpose)));
  const auto dealt_before = [&](double d) { return static_cast<uint32_t>(std::floor(d * part + offset)); };
  const uint32_t before = dealt_before(run.first), after = dealt_before(static_cast<double>(run.first) + run.count);
  const int dealt = static_cast<int>(after - before);
  return {{run.first - before, run.count - dealt}, {before, dealt}};
}

}  // namespace velour
