// Polygons cut into triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "base/process.h"
#include "scene/mesh_file.h"
#include "support/inputs.h"

namespace velour::polygon_triangles_test {
namespace {

/// Stars of many corners in any plane: the areas of the triangles add up to the polygon's.
TEST(PolygonTriangles, CoverStars) {
  PolygonTriangles cutter;
  for (const int corners : {5, 14, 101, 1000}) {
    for (const Vec3d& axis : {Vec3d(0, 0, 1), Vec3d(1, 0, 0), Vec3d(-1, 2, 0.3)}) {
      const Vec3d n = glm::normalize(axis), u = glm::normalize(glm::cross(n, Vec3d(0.3, 0.2, 0.9))),
                  v = glm::cross(n, u);
      std::vector<Vec3> polygon;
      double expected = 0;
      const auto radius = [&](int i) { return i % 2 == 0 ? 1.0 : 0.4; };
      for (int i = 0; i < 2 * corners; ++i) {
        const double angle = kPiD * i / corners;
        polygon.push_back(Vec3(100.0 * n + radius(i) * (std::cos(angle) * u + std::sin(angle) * v)));
        expected += radius(i) * radius(i + 1) * std::sin(kPiD / corners) / 2;
      }
      const auto triangles = cutter.cut(polygon);
      ASSERT_EQ(triangles.size(), polygon.size() - 2);
      double signed_area = 0, area = 0;
      for (const glm::uvec3& t : triangles) {
        const Vec3d a(polygon[t[0]]), normal = glm::cross(Vec3d(polygon[t[1]]) - a, Vec3d(polygon[t[2]]) - a);
        signed_area += glm::dot(normal, n) / 2;
        area += glm::length(normal) / 2;
      }
      EXPECT_NEAR(signed_area, expected, 1e-4 * expected) << corners;
      EXPECT_NEAR(area, expected, 1e-4 * expected) << corners;
    }
  }
}

TEST(PolygonTriangles, EndForPolygonsThatAreNone) {
  PolygonTriangles cutter;
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1.5f, 0, 0}, {0.5f, 0, 0}};
  const std::vector<Vec3> eight{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0.5f, 0}};
  const std::vector<Vec3> point(7, Vec3(3, 3, 3));
  for (const auto& polygon : {line, eight, point}) EXPECT_EQ(cutter.cut(polygon).size(), polygon.size() - 2);
}

double sum_of_areas(std::span<const Vec3> polygon, std::span<const glm::uvec3> triangles) {
  double sum = 0;
  for (const glm::uvec3& t : triangles) {
    const Vec3d a(polygon[t[0]]);
    sum += glm::length(glm::cross(Vec3d(polygon[t[1]]) - a, Vec3d(polygon[t[2]]) - a)) / 2;
  }
  return sum;
}

struct Touching {
  const char* name;
  double area;
  std::vector<Vec3> outline;
};

TEST(PolygonTriangles, OutlinesThatTouchThemselves) {
  test::record_input("OBJ", "outlines that touch themselves, at one vertex or two; edges forth and back", "read");
  const Touching cases[] = {
      {"two squares at a corner",
       2,
       {{0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {2, -1, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}}},
      {"spike outside", 4, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 5, 0}, {1, 2, 0}, {0, 2, 0}}},
      {"spike inside", 4, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}},
      {"two squares joined by a bent edge",
       2,
       {{0, 0, 0},
        {1, 0, 0},
        {1, 1, 0},
        {2, 1, 0},
        {2, 2, 0},
        {3, 2, 0},
        {3, 3, 0},
        {2, 3, 0},
        {2, 2, 0},
        {2, 1, 0},
        {1, 1, 0},
        {0, 1, 0}}},
      {"hole with a bridge",
       8,
       {{0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}, {0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}}},
  };
  PolygonTriangles cutter;
  for (const Touching& touching : cases) {
    std::vector<Vec3> outline = touching.outline;
    for (size_t first = 0; first < outline.size(); ++first) {
      EXPECT_NEAR(sum_of_areas(outline, cutter.cut(outline)), touching.area, 1e-9) << touching.name << first;
      std::ranges::rotate(outline, outline.begin() + 1);
    }
  }
}

using Point = std::array<int, 2>;

/// Unit squares, each glued by a corner to the outline of the others.
struct Squares {
  std::set<Point> squares{{0, 0}};  // by their lower left corners
  std::vector<Point> outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

  /// Inserts a square above or below and left or right of a corner of the outline, unless one is there.
  void grow(size_t corner, bool above, bool right) {
    const Point at = outline[corner], square = {at[0] - !right, at[1] - !above};
    if (squares.contains(square) || !is_outside(corner, above, right)) return;
    squares.insert(square);
    const auto [x, y] = square;
    std::vector<Point> loop{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
    std::ranges::rotate(loop, std::ranges::find(loop, at));
    outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(corner), loop.begin(), loop.end());
  }

 private:
  /// Whether the diagonal lies between the edges to the previous and to the next corner, counterclockwise.
  bool is_outside(size_t corner, bool above, bool right) const {
    const Point at = outline[corner];
    const auto eighths = [](int x, int y) { return static_cast<int>(std::lround(std::atan2(y, x) * 4 / kPiD)); };
    const auto toward = [&](const Point& p) { return eighths(p[0] - at[0], p[1] - at[1]); };
    const int previous = toward(outline[(corner + outline.size() - 1) % outline.size()]),
              next = toward(outline[(corner + 1) % outline.size()]);
    return (eighths(right ? 1 : -1, above ? 1 : -1) - previous + 8) % 8 < (next - previous + 8) % 8;
  }
};

/// Random groups of squares: the triangles cover the squares, each once, and nothing else.
TEST(PolygonTriangles, CoverSquaresThatTouch) {
  std::mt19937 random(41);
  const auto below = [&](size_t n) { return random() % n; };
  PolygonTriangles cutter;
  for (int run = 0; run < 2000; ++run) {
    Squares group;
    for (size_t i = 1 + below(20); i > 0; --i) group.grow(below(group.outline.size()), below(2) == 0, below(2) == 0);
    std::vector<Vec3> flat, turned;
    for (const auto& [x, y] : group.outline) {
      flat.push_back(Vec3(x, y, 0));
      turned.push_back(Vec3(100 + 0.6 * x - 0.8 * y, 7 + 0.5 * (0.8 * x + 0.6 * y), 0.3 * x));
    }
    const auto triangles = cutter.cut(flat);
    ASSERT_NEAR(sum_of_areas(flat, triangles), static_cast<double>(group.squares.size()), 1e-9) << run;
    for (const glm::uvec3& t : triangles) {
      if (sum_of_areas(flat, std::span(&t, 1)) == 0) continue;
      // Beside the centroid, which may lie on a border of squares.
      const Vec3 centroid = (flat[t[0]] + flat[t[1]] + flat[t[2]]) / 3.0f;
      const Vec3 inside = 0.9f * centroid + 0.1f * (0.7f * flat[t[0]] + 0.3f * flat[t[1]]);
      const Point square = {static_cast<int>(std::floor(inside.x)), static_cast<int>(std::floor(inside.y))};
      EXPECT_TRUE(group.squares.contains(square)) << run;
    }
    const double scale = glm::length(glm::cross(Vec3d(0.6, 0.4, 0.3), Vec3d(-0.8, 0.3, 0)));
    ASSERT_NEAR(sum_of_areas(turned, cutter.cut(turned)), scale * static_cast<double>(group.squares.size()), 1e-4)
        << run;
  }
}

/// The largest face takes cubic time if every corner has to be tried for every triangle.
TEST(PolygonTriangles, CornersThatAreNotFiniteTakeNoTime) {
  PolygonTriangles cutter;
  for (const size_t bad : {size_t{0}, size_t{1234}}) {
    std::vector<Vec3> polygon(PolygonTriangles::kMaxCorners);
    for (size_t i = 0; i < polygon.size(); ++i) {
      const double angle = 2 * kPiD * static_cast<double>(i) / static_cast<double>(polygon.size());
      polygon[i] = Vec3(Vec3d(std::cos(angle), std::sin(angle), 0));
    }
    polygon[bad] = Vec3(NAN);
    const double start = thread_seconds();
    EXPECT_EQ(cutter.cut(polygon).size(), polygon.size() - 2);
    EXPECT_LT(thread_seconds() - start, 1.0) << bad;
  }
}

/// The outline passes through the same three corners a thousand times.
TEST(PolygonTriangles, RepeatedCornersTakeNoTime) {
  PolygonTriangles cutter;
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  std::vector<Vec3> polygon;
  for (int i = 0; i < 3000; ++i) polygon.push_back(corners[i % 3]);
  const double start = thread_seconds();
  EXPECT_EQ(cutter.cut(polygon).size(), polygon.size() - 2);
  EXPECT_LT(thread_seconds() - start, 1.0);
}

}  // namespace
}  // namespace velour::polygon_triangles_test
