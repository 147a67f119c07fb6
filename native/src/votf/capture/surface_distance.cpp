#include "votf/capture/surface_distance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace velour {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// Vectors from the grid's points to their nearest surface points.
class NearestVectors {
 public:
  explicit NearestVectors(const DistanceGrid& grid)
      : grid_(grid),
        layer_(size_t{grid.width} * grid.height),
        square_(layer_ * grid.depth, kNone),
        to_(square_.size(), Vec3(0.0f)) {}

  void splat(std::span<const Triangle> triangles, uint32_t z);
  /// Initializes the points next to a sign change of `level` with vectors to it.
  void start(std::span<const float> level, const Progress& progress);
  bool spread(const Progress& progress);
  std::vector<float> distances() const;

 private:
  void splat(const Triangle& triangle, uint32_t z);
  void start(std::span<const float> level, const glm::uvec3& at);
  bool take(size_t point, size_t neighbor, const Vec3& step);
  /// Propagates forward and back along one axis, over `count` points that are `stride` apart.
  bool spread_line(size_t first, size_t stride, uint32_t count, const Vec3& step, bool periodic);

  const DistanceGrid& grid_;
  const size_t layer_;
  std::vector<float> square_;
  std::vector<Vec3> to_;
};

void NearestVectors::splat(std::span<const Triangle> triangles, uint32_t z) {
  const float height = grid_.first.z + static_cast<float>(z) * grid_.step.z, band = 1.5f * grid_.step.z;
  for (const Triangle& t : triangles) {
    const auto [low, high] = std::minmax({t.corner[0].z, t.corner[1].z, t.corner[2].z});
    if (low - band <= height && height <= high + band) splat(t, z);
  }
}

void NearestVectors::splat(const Triangle& t, uint32_t z) {
  const Vec3 low = glm::min(t.corner[0], glm::min(t.corner[1], t.corner[2]));
  const Vec3 high = glm::max(t.corner[0], glm::max(t.corner[1], t.corner[2]));
  const auto index = [&](float at, int axis) { return (at - grid_.first[axis]) / grid_.step[axis]; };
  const int x0 = static_cast<int>(std::ceil(index(low.x, 0) - 1.5f)),
            y0 = static_cast<int>(std::ceil(index(low.y, 1) - 1.5f));
  const int x1 = static_cast<int>(std::floor(index(high.x, 0) + 1.5f)),
            y1 = static_cast<int>(std::floor(index(high.y, 1) + 1.5f));
  const int width = static_cast<int>(grid_.width), height = static_cast<int>(grid_.height);
  const auto wrapped = [](int i, int n) { return static_cast<size_t>((i % n + n) % n); };
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Vec3 p = grid_.first + Vec3(x, y, z) * grid_.step;
      const Vec3 to = nearest_point(t, p) - p;
      const float square = glm::dot(to, to);
      const size_t point = z * layer_ + wrapped(y, height) * grid_.width + wrapped(x, width);
      if (square >= square_[point]) continue;
      square_[point] = square;
      to_[point] = to;
    }
  }
}

void NearestVectors::start(std::span<const float> level, const Progress& progress) {
  tbb::parallel_for(0u, grid_.depth, [&](uint32_t z) {
    progress.check();
    for (uint32_t y = 0; y < grid_.height; ++y) {
      for (uint32_t x = 0; x < grid_.width; ++x) start(level, {x, y, z});
    }
  });
}

void NearestVectors::start(std::span<const float> level, const glm::uvec3& at) {
  const glm::uvec3 extent(grid_.width, grid_.height, grid_.depth);
  const auto index = [&](const glm::uvec3& p) { return p.z * layer_ + size_t{p.y} * grid_.width + p.x; };
  const size_t point = index(at);
  const float here = level[point];
  Vec3 inverse(0.0f);   // 1 / signed distance along each axis
  bool beyond = false;  // a neighbor is on the other side
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool onwards : {false, true}) {
      const uint32_t border = onwards ? extent[axis] - 1 : 0;
      if (at[axis] == border && (axis == 2 || extent[axis] == 1)) continue;
      glm::uvec3 beside = at;
      beside[axis] = at[axis] == border ? extent[axis] - 1 - border : onwards ? at[axis] + 1 : at[axis] - 1;
      const float there = level[index(beside)];
      beyond |= (here < 0) != (there < 0);
      const float share = here / (here - there);  // of the step; above 1 if the surface is behind the neighbor
      if (!(share >= 0) || !std::isfinite(share)) continue;
      const float way = std::max(share, 1e-3f) * grid_.step[axis];
      if (1 / way > std::abs(inverse[axis])) inverse[axis] = (onwards ? 1.0f : -1.0f) / way;
    }
  }
  const float square = glm::dot(inverse, inverse);
  if (!beyond && square * 2.25f * grid_.step.x * grid_.step.x < 1) return;
  to_[point] = inverse / square;
  square_[point] = 1 / square;
}

bool NearestVectors::take(size_t point, size_t neighbor, const Vec3& step) {
  if (square_[neighbor] == kNone) return false;
  const Vec3 to = to_[neighbor] + step;
  const float square = glm::dot(to, to);
  if (square >= square_[point]) return false;
  square_[point] = square;
  to_[point] = to;
  return true;
}

bool NearestVectors::spread_line(size_t first, size_t stride, uint32_t count, const Vec3& step, bool periodic) {
  bool changed = false;
  const uint32_t rounds = periodic ? 2 * count : count;
  for (uint32_t i = 1; i < rounds; ++i) {
    changed |= take(first + i % count * stride, first + (i - 1) % count * stride, -step);
  }
  for (uint32_t i = rounds - 1; i-- > 0;) {
    changed |= take(first + i % count * stride, first + (i + 1) % count * stride, step);
  }
  return changed;
}

bool NearestVectors::spread(const Progress& progress) {
  const uint32_t w = grid_.width, h = grid_.height, d = grid_.depth;
  std::vector<uint8_t> changed(std::max(h, w) * size_t{3}, 0);
  tbb::parallel_for(0u, h, [&](uint32_t y) {
    progress.check();
    for (uint32_t z = 0; z < d; ++z) changed[y] |= spread_line(z * layer_ + y * w, 1, w, {grid_.step.x, 0, 0}, true);
  });
  tbb::parallel_for(0u, w, [&](uint32_t x) {
    progress.check();
    for (uint32_t z = 0; z < d; ++z) changed[h + x] |= spread_line(z * layer_ + x, w, h, {0, grid_.step.y, 0}, true);
  });
  tbb::parallel_for(0u, h, [&](uint32_t y) {
    progress.check();
    for (uint32_t x = 0; x < w; ++x) {
      changed[y] |= spread_line(size_t{y} * w + x, layer_, d, {0, 0, grid_.step.z}, false);
    }
  });
  return std::ranges::any_of(changed, [](uint8_t c) { return c != 0; });
}

std::vector<float> NearestVectors::distances() const {
  std::vector<float> distance;
  distance.reserve(square_.size());
  for (float s : square_) distance.push_back(std::sqrt(s));
  return distance;
}

}  // namespace

Vec3 nearest_point(const Triangle& t, const Vec3& p) {
  const Vec3 &a = t.corner[0], &b = t.corner[1], &c = t.corner[2];
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

std::vector<float> surface_distances(std::span<const Triangle> triangles, const DistanceGrid& grid,
                                     Progress& progress) {
  NearestVectors nearest(grid);
  tbb::parallel_for(0u, grid.depth, [&](uint32_t z) {
    progress.check();
    nearest.splat(triangles, z);
  });
  while (nearest.spread(progress)) {
  }
  return nearest.distances();
}

std::vector<float> level_distances(std::span<const float> level, const DistanceGrid& grid, Progress& progress) {
  NearestVectors nearest(grid);
  nearest.start(level, progress);
  while (nearest.spread(progress)) {
  }
  return nearest.distances();
}

}  // namespace velour
