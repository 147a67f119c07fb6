#include "scene/corner_tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sphere/frame.h"

namespace velour {
namespace {

Vec3 across(const Vec3& v, const Vec3& normal) { return v - glm::dot(v, normal) * normal; }

Vec3 unit_or_zero(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : Vec3(0.0f);
}

/// Position, normal and texture coordinate of a corner; corners are merged if all of them are equal.
using Place = std::array<float, 8>;

/// [corners] Group of each corner, counted from 0; equal places have the same group.
std::vector<uint32_t> welded(const std::vector<Place>& place) {
  std::vector<uint32_t> order(place.size()), number(place.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return place[a] != place[b] ? place[a] < place[b] : a < b; });
  uint32_t count = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && place[order[i]] != place[order[i - 1]]) ++count;
    number[order[i]] = count;
  }
  return number;
}

class TangentSums {
 public:
  TangentSums(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, std::span<const Vec3> normals,
              std::span<const Vec2> uvs)
      : positions_(positions), triangles_(triangles), normals_(normals), uvs_(uvs) {
    std::vector<Place> place(normals.size());
    for (size_t c = 0; c < place.size(); ++c) {
      const Vec3 p = position(c), n = normals[c];
      const Vec2 t = uv(c);
      place[c] = {p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y};
      for (float& x : place[c]) x += 0.0f;  // -0 is 0
    }
    group_ = welded(place);
    sum_.resize(2 * (group_.empty() ? 0 : 1 + static_cast<size_t>(*std::ranges::max_element(group_))), Vec3(0.0f));
    for (size_t t = 0; t < triangles.size(); ++t) add(t);
  }

  CornerTangent at(size_t corner) const {
    const float own = side(corner / 3);
    for (const float s : {own != 0 ? own : 1.0f, own != 0 ? -own : -1.0f}) {
      const Vec3 direction = unit_or_zero(sum_[slot(corner, s)]);
      if (direction != Vec3(0.0f)) return {direction, own != 0 ? own : s};
    }
    return {Frame::about(normals_[corner]).x, 1.0f};
  }

 private:
  Vec3 position(size_t corner) const {
    return positions_[triangles_[corner / 3][static_cast<glm::length_t>(corner % 3)]];
  }
  Vec2 uv(size_t corner) const {
    const Vec2 t = uvs_[corner];
    return std::isfinite(t.x + t.y) ? t : Vec2(0.0f);
  }
  size_t slot(size_t corner, float side) const { return 2 * static_cast<size_t>(group_[corner]) + (side < 0 ? 1 : 0); }

  /// CornerTangent::side of a triangle; 0 if it has no area in texture space.
  float side(size_t triangle) const {
    const Vec2 a = uv(3 * triangle + 1) - uv(3 * triangle), b = uv(3 * triangle + 2) - uv(3 * triangle);
    const float area = a.x * b.y - a.y * b.x;
    return area > 0 ? 1.0f : (area < 0 ? -1.0f : 0.0f);
  }

  void add(size_t triangle) {
    const float s = side(triangle);
    if (s == 0) return;
    const size_t first = 3 * triangle;
    const Vec2 a = uv(first + 1) - uv(first), b = uv(first + 2) - uv(first);
    const Vec3 along =
        s * (b.y * (position(first + 1) - position(first)) - a.y * (position(first + 2) - position(first)));
    for (size_t k = 0; k < 3; ++k) {
      const size_t corner = first + k;
      const Vec3& normal = normals_[corner];
      const auto edge = [&](size_t step) {
        return unit_or_zero(across(position(first + (k + step) % 3) - position(corner), normal));
      };
      const float angle = std::acos(std::clamp(glm::dot(edge(1), edge(2)), -1.0f, 1.0f));
      sum_[slot(corner, s)] += angle * unit_or_zero(across(along, normal));
    }
  }

  std::span<const Vec3> positions_;
  std::span<const glm::uvec3> triangles_;
  std::span<const Vec3> normals_;
  std::span<const Vec2> uvs_;
  std::vector<uint32_t> group_;  // of each corner
  std::vector<Vec3> sum_;        // two per group: of triangles with side 1 and with side -1
};

}  // namespace

std::vector<CornerTangent> corner_tangents(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                           std::span<const Vec3> corner_normals, std::span<const Vec2> corner_uvs) {
  const TangentSums sums(positions, triangles, corner_normals, corner_uvs);
  std::vector<CornerTangent> tangents(corner_normals.size());
  for (size_t c = 0; c < tangents.size(); ++c) tangents[c] = sums.at(c);
  return tangents;
}

}  // namespace velour
