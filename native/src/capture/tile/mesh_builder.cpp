#include "capture/tile/mesh_builder.h"

#include <cmath>

#include "math/sphere/random.h"

namespace velour {

namespace {

/// Number of lines of points for `cells` cells.
int lines(int cells, const GridEnd& end) { return end.joined ? cells : cells + 1; }

Vec3d unit_direction(double longitude, double colatitude) {
  const double s = std::sin(colatitude);
  return {s * std::cos(longitude), s * std::sin(longitude), std::cos(colatitude)};
}

double angle(const Vec3d& a, const Vec3d& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

}  // namespace

uint32_t MeshBuilder::add_vertex(const Vec3d& position) {
  const auto number = static_cast<uint32_t>(mesh_.positions.size());
  mesh_.positions.emplace_back(position);
  original_.push_back(number);
  return number;
}

void MeshBuilder::add_triangle(const glm::uvec3& corners, const Vec2 (&uvs)[3], uint32_t slot) {
  mesh_.triangles.push_back(corners);
  mesh_.corner_uvs.insert(mesh_.corner_uvs.end(), uvs, uvs + 3);
  mesh_.slots.push_back(slot);
}

void MeshBuilder::add_grid(const Grid& grid, const Surface& surface) {
  const auto first = static_cast<uint32_t>(mesh_.positions.size());
  const int lines_v = lines(grid.cells_v, grid.end_v);
  for (int i = 0; i < lines(grid.cells_u, grid.end_u); ++i) {
    for (int j = 0; j < lines_v; ++j) {
      // The last line reuses the coordinates of the first, so that copies of the tile meet without cracks.
      const int i0 = i % grid.cells_u, j0 = j % grid.cells_v;
      Vec3d position = surface(i0 / double(grid.cells_u), j0 / double(grid.cells_v));
      if (i0 != i) position += grid.end_u.step;
      if (j0 != j) position += grid.end_v.step;
      original_[add_vertex(position)] = first + static_cast<uint32_t>(i0 * lines_v + j0);
    }
  }
  for (int i = 0; i < grid.cells_u; ++i) {
    for (int j = 0; j < grid.cells_v; ++j) add_cell(grid, i, j, first);
  }
}

void MeshBuilder::add_cell(const Grid& grid, int i, int j, uint32_t first) {
  const int lines_u = lines(grid.cells_u, grid.end_u), lines_v = lines(grid.cells_v, grid.end_v);
  const auto vertex = [&](int a, int b) {
    return first + static_cast<uint32_t>((a % lines_u) * lines_v + b % lines_v);
  };
  const auto uv = [&](int a, int b) { return Vec2(float(a) / float(grid.cells_u), float(b) / float(grid.cells_v)); };
  const uint32_t p00 = vertex(i, j), p10 = vertex(i + 1, j), p11 = vertex(i + 1, j + 1), p01 = vertex(i, j + 1);
  add_triangle({p00, p10, p11}, {uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)}, grid.slot);
  add_triangle({p00, p11, p01}, {uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)}, grid.slot);
}

void MeshBuilder::add_globe(int around, uint32_t slot, const Globe& globe) {
  const int rows = around / 2;
  // Rows from just above the south pole to just below the north pole: closed around, open at both ends.
  const auto first = static_cast<uint32_t>(mesh_.positions.size());
  for (int j = 1; j < rows; ++j) {
    for (int i = 0; i < around; ++i) {
      add_vertex(globe(unit_direction(2 * kPiD * i / around, kPiD * (1 - j / double(rows)))));
    }
  }
  const auto vertex = [&](int i, int j) { return first + static_cast<uint32_t>((j - 1) * around + i % around); };
  const auto uv = [&](int i, int j) { return Vec2(float(i) / float(around), float(j) / float(rows)); };
  for (int j = 1; j < rows - 1; ++j) {
    for (int i = 0; i < around; ++i) {
      add_triangle({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)}, {uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)},
                   slot);
      add_triangle({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}, {uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)},
                   slot);
    }
  }
  add_pole(around, add_vertex(globe({0, 0, -1})), vertex(0, 1), false, slot);
  add_pole(around, add_vertex(globe({0, 0, 1})), vertex(0, rows - 1), true, slot);
}

void MeshBuilder::add_pole(int around, uint32_t pole, uint32_t ring, bool north, uint32_t slot) {
  const float v = north ? 1.0f : 0.0f;
  const float v_ring = north ? 1.0f - 2.0f / float(around) : 2.0f / float(around);
  for (int i = 0; i < around; ++i) {
    const uint32_t a = ring + static_cast<uint32_t>(i), b = ring + static_cast<uint32_t>((i + 1) % around);
    const Vec2 uv_a(float(i) / float(around), v_ring), uv_b(float(i + 1) / float(around), v_ring);
    const Vec2 uv_pole(0.5f * (uv_a.x + uv_b.x), v);
    if (north) {
      add_triangle({a, b, pole}, {uv_a, uv_b, uv_pole}, slot);
    } else {
      add_triangle({b, a, pole}, {uv_b, uv_a, uv_pole}, slot);
    }
  }
}

TileMesh MeshBuilder::finish() {
  std::vector<Vec3d> sums(mesh_.positions.size(), Vec3d(0.0));
  for (const glm::uvec3& t : mesh_.triangles) {
    const Vec3d p[3] = {Vec3d(mesh_.positions[t.x]), Vec3d(mesh_.positions[t.y]), Vec3d(mesh_.positions[t.z])};
    const Vec3d normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    for (int k = 0; k < 3; ++k) sums[original_[t[k]]] += angle(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]) * normal;
  }
  for (const glm::uvec3& t : mesh_.triangles) {
    for (int k = 0; k < 3; ++k) mesh_.corner_normals.emplace_back(glm::normalize(sums[original_[t[k]]]));
  }
  return std::move(mesh_);
}

namespace {

double smooth(double t) { return t * t * (3 - 2 * t); }

int wrapped(int i, int n) { return ((i % n) + n) % n; }

}  // namespace

double PeriodicNoise::operator()(const glm::dvec2& at) const {
  const glm::dvec2 place = at * glm::dvec2(cells), corner = glm::floor(place), rest = place - corner;
  const auto value = [&](int dx, int dy) {
    const int x = wrapped(int(corner.x) + dx, cells.x), y = wrapped(int(corner.y) + dy, cells.y);
    return double(
        RandomStream(seed, stream, static_cast<uint64_t>(y) * static_cast<uint64_t>(cells.x) + static_cast<uint64_t>(x))
            .next());
  };
  const double u = smooth(rest.x), v = smooth(rest.y);
  return glm::mix(glm::mix(value(0, 0), value(1, 0), u), glm::mix(value(0, 1), value(1, 1), u), v);
}

}  // namespace velour
