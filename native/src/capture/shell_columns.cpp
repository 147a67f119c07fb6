#include "capture/shell_columns.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace velour {
namespace {

constexpr int kMostCrossings = 1024;

/// In units of `aside`.
constexpr std::array<Vec2, 5> kTries = {Vec2(0, 0), Vec2(0.37f, 0.61f), Vec2(-0.71f, 0.23f), Vec2(0.53f, -0.89f),
                                        Vec2(-0.97f, -0.47f)};

}  // namespace

ShellColumns::ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed)
    : tile_(tile), closed_(closed), lines_(places.size()) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, places.size(), 256), [&](const tbb::blocked_range<size_t>& part) {
    TileRays rays(tile_);
    for (size_t i = part.begin(); i < part.end(); ++i) {
      for (const Vec2& shift : kTries) {
        std::vector<Crossing> line = follow(rays, tile_.into_cell(places[i] + aside * shift));
        const bool good = ends_well(line);
        if (good || &shift == &kTries.front()) lines_[i] = std::move(line);
        if (good) break;
      }
    }
  });
  unclosed_ = static_cast<size_t>(std::ranges::count_if(lines_, [&](const auto& line) { return !ends_well(line); }));
}

std::vector<ShellColumns::Crossing> ShellColumns::follow(TileRays& rays, const Vec2& place) const {
  const float margin = 1e-3f * (tile_.thickness() + tile_.period().x), rounding = 1e-6f * (tile_.thickness() + margin);
  std::vector<Crossing> line;
  int depth = 0;
  float from = tile_.top() + margin;
  while (line.size() < kMostCrossings) {
    Ray ray{Vec3(place, from), 0, {0, 0, -1}};
    Hit hit;
    rays.intersect({&ray, 1}, {&hit, 1}, nullptr);
    if (hit.instance == kNoHit) break;
    const float height = from - hit.distance;
    depth += hit.geometric_normal.z > 0 ? 1 : -1;
    line.push_back({height, depth});
    from = height - rounding;
  }
  return line;
}

bool ShellColumns::ends_well(const std::vector<Crossing>& line) const {
  const int depth = line.empty() ? 0 : line.back().depth;
  return closed_ ? depth > 0 : depth == 0;
}

bool ShellColumns::inside(size_t line, float height) const {
  const std::vector<Crossing>& crossings = lines_[line];
  const auto below = std::ranges::find_if(crossings, [&](const Crossing& c) { return c.height < height; });
  const int depth = below == crossings.begin() ? 0 : std::prev(below)->depth;
  const int never_left = closed_ || crossings.empty() ? 0 : std::max(0, crossings.back().depth);
  return depth > never_left;
}

}  // namespace velour
