#include "capture/shell_columns.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace velour {
namespace {

constexpr size_t kMostCrossings = 1024, kBlock = 256;

/// Offsets of the tries, in units of `aside`.
constexpr std::array<Vec2, 5> kTries = {Vec2(0, 0), Vec2(0.37f, 0.61f), Vec2(-0.71f, 0.23f), Vec2(0.53f, -0.89f),
                                        Vec2(-0.97f, -0.47f)};

}  // namespace

ShellColumns::ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed,
                           RayShare& share)
    : tile_(tile), closed_(closed), lines_(places.size()) {
  tbb::parallel_for(size_t{0}, (places.size() + kBlock - 1) / kBlock, [&](size_t block) {
    const size_t first = block * kBlock, count = std::min(kBlock, places.size() - first);
    share.record(block, {0, 0, static_cast<int>(count), 1}, 1, [&](RayLog* log) {
      follow(std::span(places).subspan(first, count), aside, std::span(lines_).subspan(first, count), log);
    });
  });
  unclosed_ = static_cast<size_t>(std::ranges::count_if(lines_, [&](const Line& line) { return !ends_well(line); }));
}

void ShellColumns::follow(std::span<const Vec2> places, float aside, std::span<Line> lines, RayLog* log) const {
  TileRays rays(tile_);
  std::vector<size_t> tried(places.size());
  std::iota(tried.begin(), tried.end(), size_t{0});
  for (const Vec2& shift : kTries) {
    std::vector<Vec2> shifted;
    for (const size_t i : tried) shifted.push_back(tile_.into_cell(places[i] + aside * shift));
    std::vector<Line> found = followed(rays, shifted, log);
    std::vector<size_t> again;
    for (size_t k = 0; k < tried.size(); ++k) {
      const bool good = ends_well(found[k]);
      if (!good) again.push_back(tried[k]);
      if (good || &shift == &kTries.front()) lines[tried[k]] = std::move(found[k]);
    }
    if (again.empty()) return;
    tried = std::move(again);
  }
}

std::vector<ShellColumns::Line> ShellColumns::followed(TileRays& tracer, std::span<const Vec2> places,
                                                       RayLog* log) const {
  const float margin = 1e-3f * (tile_.thickness() + tile_.period().x), rounding = 1e-6f * (tile_.thickness() + margin);
  std::vector<Line> lines(places.size());
  std::vector<Ray> rays;
  std::vector<size_t> line_of;
  for (size_t i = 0; i < places.size(); ++i) {
    rays.push_back({Vec3(places[i], tile_.top() + margin), 0, {0, 0, -1}});
    line_of.push_back(i);
  }
  std::vector<Hit> hits(rays.size());
  while (!rays.empty()) {
    tracer.intersect(rays, std::span(hits).first(rays.size()), log);
    size_t left = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
      Line& line = lines[line_of[k]];
      if (hits[k].instance == kNoHit || line.size() == kMostCrossings) continue;
      const float height = rays[k].origin.z - hits[k].distance;
      const int above = line.empty() ? 0 : line.back().depth;
      line.push_back({height, above + (hits[k].geometric_normal.z > 0 ? 1 : -1)});
      line_of[left] = line_of[k];
      rays[left++] = {Vec3(places[line_of[k]], height - rounding), 0, {0, 0, -1}};
    }
    rays.resize(left);
  }
  return lines;
}

bool ShellColumns::ends_well(const Line& line) const {
  const int depth = line.empty() ? 0 : line.back().depth;
  return closed_ ? depth > 0 : depth == 0;
}

bool ShellColumns::inside(size_t line, float height) const {
  const Line& crossings = lines_[line];
  const auto below = std::ranges::find_if(crossings, [&](const Crossing& c) { return c.height < height; });
  const int depth = below == crossings.begin() ? 0 : std::prev(below)->depth;
  const int never_left = closed_ || crossings.empty() ? 0 : std::max(0, crossings.back().depth);
  return depth > never_left;
}

}  // namespace velour
