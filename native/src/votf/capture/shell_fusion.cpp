#include "votf/capture/shell_fusion.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr float kBand = 2;       // pitches behind the surface seen by a view within which the view counts
constexpr float kWhole = 0.98f;  // minimum coverage for a texel's mean height to be that of a surface
constexpr float kSmooth = 1;     // maximum spread in pitches, and half the maximum step; more is an edge

VotfVolume without_distances(const VotfVolume& volume) {
  VotfVolume sizes = volume;
  sizes.distance.clear();
  return sizes;
}

/// Inserts `number` into a descending list and drops the last element.
void insert(float number, std::span<float> falling) {
  for (float& f : falling) {
    if (number > f) std::swap(number, f);
  }
}

}  // namespace

/// The texels of a view whose heights are those of a surface rather than an edge.
struct ShellFusion::Surfaces {
  std::vector<float> weight;  // 0: an edge
  std::vector<float> slant;   // pitches of perpendicular distance per width of height

  Surfaces(const SeenTexels& seen, const TileTexels& texels, float pitch);
};

ShellFusion::Surfaces::Surfaces(const SeenTexels& seen, const TileTexels& texels, float pitch) {
  if (seen.height.empty()) return;
  weight.assign(texels.size(), 0.0f);
  slant.assign(texels.size(), 0.0f);
  const float most = kSmooth * pitch;
  const auto whole = [&](size_t t) { return seen.coverage[t] >= kWhole && seen.spread[t] <= most; };
  const Vec3 along = seen.wv / seen.wv.z;
  for (uint32_t y = 0; y < texels.height; ++y) {
    for (uint32_t x = 0; x < texels.width; ++x) {
      const size_t t = size_t{y} * texels.width + x;
      if (!whole(t)) continue;
      // Uses the neighbor along each axis with the smaller step in height.
      const auto step = [&](size_t a, size_t b, const Vec3& onwards) {
        const bool first = std::abs(seen.height[a] - seen.height[t]) < std::abs(seen.height[b] - seen.height[t]);
        const float rise = first ? seen.height[a] - seen.height[t] : seen.height[t] - seen.height[b];
        return onwards + rise * along;
      };
      const size_t row = size_t{y} * texels.width;
      const size_t right = row + (x + 1) % texels.width, left = row + (x + texels.width - 1) % texels.width;
      const size_t above = size_t{(y + 1) % texels.height} * texels.width + x;
      const size_t below = size_t{(y + texels.height - 1) % texels.height} * texels.width + x;
      const Vec3 normal =
          glm::normalize(glm::cross(step(right, left, {1 / static_cast<float>(texels.width), 0, 0}),
                                    step(above, below, {0, texels.aspect / static_cast<float>(texels.height), 0})));
      const float cosine = std::max(std::abs(glm::dot(normal, seen.wv)), 0.05f);
      weight[t] = cosine / (1 + seen.spread[t] * seen.spread[t] / (most * most));
      slant[t] = cosine / (std::abs(seen.wv.z) * pitch);
    }
  }
}

ShellFusion::ShellFusion(const VotfVolume& volume, const TileTexels& texels, bool closed)
    : grid_(without_distances(volume)),
      texels_(texels),
      closed_(closed),
      evidence_(size_t{grid_.width} * grid_.height * grid_.depth) {}

void ShellFusion::add(const SeenTexels& seen, const Progress& progress) {
  ++views_;
  const Surfaces surfaces(seen, texels_, grid_.pitch());
  tbb::parallel_for(0u, grid_.depth, [&](uint32_t z) {
    progress.check();
    add_layer(seen, surfaces, z);
  });
}

void ShellFusion::add_layer(const SeenTexels& seen, const Surfaces& surfaces, uint32_t z) {
  const float height = grid_.bottom + static_cast<float>(z) * grid_.step();
  const Vec2 aside = Vec2(seen.wv) * ((grid_.reference - height) / seen.wv.z);
  // Converts to texels, counted from the center of the first one.
  const Vec2 scale(static_cast<float>(texels_.width), static_cast<float>(texels_.height) / texels_.aspect);
  const TileTexels points{grid_.width, grid_.height, grid_.aspect};
  std::vector<LinearTexels> columns;
  for (uint32_t x = 0; x < grid_.width; ++x) {
    columns.emplace_back((points.center(x, 0).x + aside.x) * scale.x - 0.5f, texels_.width);
  }
  Evidence* evidence = evidence_.data() + size_t{z} * points.size();
  for (uint32_t y = 0; y < grid_.height; ++y) {
    const LinearTexels row((points.center(0, y).y + aside.y) * scale.y - 0.5f, texels_.height);
    for (const LinearTexels& column : columns) {
      const BilinearTexels at = bilinear_between(column, row, texels_.width);
      float coverage = 0;
      for (size_t k = 0; k < 4; ++k) coverage += at.weight[k] * seen.coverage[at.index[k]];
      insert(0.5f - coverage, evidence->open);
      if (!seen.height.empty()) add_distance(seen, surfaces, at, height, *evidence);
      ++evidence;
    }
  }
}

void ShellFusion::add_distance(const SeenTexels& seen, const Surfaces& surfaces, const BilinearTexels& at, float height,
                               Evidence& evidence) const {
  const auto heaviest = static_cast<size_t>(std::ranges::max_element(at.weight) - at.weight.begin());
  const uint32_t nearest = at.index[heaviest];
  const float weight = surfaces.weight[nearest];
  if (weight == 0) return;
  float mean = 0, sum = 0;
  for (size_t k = 0; k < 4; ++k) {
    const uint32_t t = at.index[k];
    const bool same =
        surfaces.weight[t] > 0 && std::abs(seen.height[t] - seen.height[nearest]) <= 2 * kSmooth * grid_.pitch();
    mean += same ? at.weight[k] * seen.height[t] : 0;
    sum += same ? at.weight[k] : 0;
  }
  const float before = seen.wv.z < 0 ? mean / sum - height : height - mean / sum;
  const float distance = before * surfaces.slant[nearest] / kBand;
  if (distance < -1) return;
  evidence.weight += weight;
  evidence.distance += weight * std::min(distance, 1.0f);
}

std::vector<float> ShellFusion::level() const {
  std::vector<float> level;
  const size_t layer = size_t{grid_.width} * grid_.height;
  for (size_t i = 0; i < evidence_.size(); ++i) {
    const Evidence& e = evidence_[i];
    const size_t z = i / layer;
    const bool outside = z + 1 == grid_.depth || (z == 0 && !closed_);  // these points lie beyond the structure
    const float seen = e.weight > 0 ? 0.5f * e.distance / e.weight : -0.5f;
    level.push_back(outside ? 0.5f : std::max(open(e), seen));
  }
  return level;
}

}  // namespace velour
