#include "capture/goniometer/periodic_tile.h"

#include <algorithm>
#include <utility>

namespace velour {
namespace {

/// Number of cells that the mesh repeats beyond each side of the period, so that no ray slips through the seam.
constexpr int kPad = 1;

/// Distance along `direction` to the far side of [0, period].
float distance_to_side(float origin, float direction, float period) {
  if (direction == 0.0f) return std::numeric_limits<float>::infinity();
  return std::max(0.0f, ((direction > 0.0f ? period : 0.0f) - origin) / direction);
}

std::vector<Vec3> padded_positions(const HeightField& field) {
  std::vector<Vec3> positions;
  const int last = field.cells + kPad;
  positions.reserve(static_cast<size_t>(last + kPad + 1) * static_cast<size_t>(last + kPad + 1));
  for (int y = -kPad; y <= last; ++y) {
    for (int x = -kPad; x <= last; ++x) {
      positions.emplace_back(static_cast<float>(x), static_cast<float>(y * field.cell_y), field.at(x, y));
    }
  }
  return positions;
}

/// Two triangles per cell, counterclockwise from above, the one below the diagonal first.
std::vector<glm::uvec3> padded_triangles(int cells) {
  const auto side = static_cast<uint32_t>(cells + 2 * kPad);
  std::vector<glm::uvec3> triangles;
  triangles.reserve(size_t{2} * side * side);
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t v = y * (side + 1) + x;
      triangles.emplace_back(v, v + 1, v + side + 2);
      triangles.emplace_back(v, v + side + 2, v + side + 1);
    }
  }
  return triangles;
}

/// Facet of the period that corresponds to triangle `triangle` of the padded mesh.
int facet_of_triangle(uint32_t triangle, int cells) {
  const int side = cells + 2 * kPad, cell = static_cast<int>(triangle / 2);
  const int x = (cell % side - kPad + cells) % cells, y = (cell / side - kPad + cells) % cells;
  return 2 * (y * cells + x) + static_cast<int>(triangle % 2);
}

}  // namespace

PeriodicTile::PeriodicTile(HeightField field, std::vector<uint8_t> base_cells)
    : field_(std::move(field)), base_cells_(std::move(base_cells)) {
  const auto cells = static_cast<double>(field_.cells);
  period_ = {cells, cells * field_.cell_y};
  top_ = *std::max_element(field_.height.begin(), field_.height.end());
  lift_ = std::max(period_.x, period_.y) * 0x1p-20f;  // a few roundings of the largest coordinate
  const auto triangles = padded_triangles(field_.cells);
  scene_.add_instance(scene_.add_mesh(padded_positions(field_), triangles), {});
  // One thread: tiles are built in parallel, and the BVH must not depend on the number of threads.
  scene_.commit(1, nullptr, EmbreeScene::Levels::one);
}

Vec2 PeriodicTile::slope(int facet) const {
  const int cell = facet / 2, x = cell % field_.cells, y = cell / field_.cells;
  const int row = y + facet % 2, column = x + 1 - facet % 2;
  const float along_x = field_.at(x + 1, row) - field_.at(x, row);
  const float along_y = field_.at(column, y + 1) - field_.at(column, y);
  return {along_x, along_y / static_cast<float>(field_.cell_y)};
}

FacetPoint PeriodicTile::surface_point(int facet, const Vec3& position) const {
  const Vec2 s = slope(facet);
  const Vec3 normal = glm::normalize(Vec3(-s.x, -s.y, 1.0f));
  return {position + lift_ * normal, normal, is_base(facet)};
}

FacetPoint PeriodicTile::point_above(const Vec2& u) const {
  const auto cells = static_cast<float>(field_.cells);
  const Vec2 at = u * cells;
  const int x = std::min(static_cast<int>(at.x), field_.cells - 1);
  const int y = std::min(static_cast<int>(at.y), field_.cells - 1);
  const float in_x = at.x - static_cast<float>(x), in_y = at.y - static_cast<float>(y);
  const int facet = 2 * (y * field_.cells + x) + (in_y > in_x ? 1 : 0);
  const Vec2 s = slope(facet);
  const auto cell_y = static_cast<float>(field_.cell_y);
  return surface_point(facet, {at.x, at.y * cell_y, field_.at(x, y) + s.x * in_x + s.y * in_y * cell_y});
}

bool PeriodicTile::enter_next_period(Ray& ray) const {
  const Vec3& d = ray.direction;
  const float to_x = distance_to_side(ray.origin.x, d.x, period_.x);
  const float to_y = distance_to_side(ray.origin.y, d.y, period_.y);
  const float distance = std::min(to_x, to_y);
  if (std::isinf(distance) || (d.z > 0.0f && ray.origin.z + distance * d.z >= top_)) return false;
  ray.origin += distance * d;
  if (to_x <= to_y) ray.origin.x = d.x > 0.0f ? 0.0f : period_.x;
  if (to_y <= to_x) ray.origin.y = d.y > 0.0f ? 0.0f : period_.y;
  return true;
}

Fate PeriodicTile::trace(const Vec3& origin, const Vec3& direction, FacetPoint& hit) const {
  Ray ray{origin, 0.0f, direction};
  for (int period = 0; period < kMaxPeriods; ++period) {
    Hit found;
    scene_.intersect(ray, found);
    if (found.instance != kNoHit) {
      const int facet = facet_of_triangle(found.triangle, field_.cells);
      hit = surface_point(facet, ray.origin + found.distance * direction);
      return Fate::hit;
    }
    if (!enter_next_period(ray)) return direction.z > 0.0f ? Fate::escaped : Fate::lost;
  }
  return Fate::lost;
}

bool PeriodicTile::escapes(const Vec3& origin, const Vec3& direction) const {
  Ray ray{origin, 0.0f, direction};
  for (int period = 0; period < kMaxPeriods; ++period) {
    if (scene_.occluded(ray)) return false;
    if (!enter_next_period(ray)) return direction.z > 0.0f;
  }
  return false;
}

}  // namespace velour
