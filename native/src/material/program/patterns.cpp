// Blender's textures without noise (kernel/svm/gradient.h, checker.h, brick.h, magic.h of Cycles).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include "material/program/operands.h"

namespace velour {
namespace {

constexpr float kTwoPi = 2 * kPi;

float gradient(GradientKind kind, const Vec3& p) {
  switch (kind) {
    case GradientKind::linear:
      return p.x;
    case GradientKind::quadratic: {
      const float r = std::max(p.x, 0.0f);
      return r * r;
    }
    case GradientKind::easing:
      return smoothed(p.x);
    case GradientKind::diagonal:
      return (p.x + p.y) * 0.5f;
    case GradientKind::radial:
      return std::atan2(p.y, p.x) / kTwoPi + 0.5f;
    case GradientKind::spherical:
    case GradientKind::quadratic_sphere: {
      const float r = std::max(0.999999f - glm::length(p), 0.0f);  // exactly 0 on the unit sphere
      return kind == GradientKind::spherical ? r : r * r;
    }
  }
  return 0;
}

/// Whether the cell of an integer coordinate is odd; moved a little, so that faces at integers do not flicker.
bool is_odd(float x) { return std::fmod(std::floor((x + 0.000001f) * 0.999999f), 2.0f) != 0; }

bool is_first_color(const Vec3& p) { return (is_odd(p.x) == is_odd(p.y)) == is_odd(p.z); }

/// Number in [0, 1) of a brick: an integer hash of Blender's own.
float brick_number(uint32_t brick) {
  uint32_t n = (brick + 1013) & 0x7fffffff;
  n = (n >> 13) ^ n;
  const uint32_t hashed = (n * (n * n * 60493u + 19990303u) + 1376312589u) & 0x7fffffff;
  return 0.5f * (static_cast<float>(hashed) / 1073741824.0f);
}

int32_t floored(float x) { return static_cast<int32_t>(std::clamp(std::floor(x), -2147483520.0f, 2147483520.0f)); }

struct Brick {
  float tint, mortar;  // shares of color 2 and of the mortar
};

struct BrickShape {
  float mortar_size, smoothness, bias, width, height, offset, squash;
  int32_t offset_frequency, squash_frequency;
};

Brick brick_at(const Vec3& p, const BrickShape& shape) {
  const int32_t row = floored(p.y / shape.height);
  float width = shape.width, shift = 0;
  if (shape.offset_frequency != 0 && shape.squash_frequency != 0) {
    if (row % shape.squash_frequency == 0) width *= shape.squash;
    if (row % shape.offset_frequency == 0) shift = width * shape.offset;
  }
  const int32_t column = floored((p.x + shift) / width);
  const float x = p.x + shift - width * static_cast<float>(column), y = p.y - shape.height * static_cast<float>(row);
  const uint32_t number = (static_cast<uint32_t>(row) << 16) + (static_cast<uint32_t>(column) & 0xffff);
  const float edge = std::min(std::min(x, y), std::min(width - x, shape.height - y));
  float mortar = 0;
  if (edge < shape.mortar_size) {
    mortar = shape.smoothness == 0 ? 1.0f : smoothed((1 - edge / shape.mortar_size) / shape.smoothness);
  }
  return {saturated(brick_number(number) + shape.bias), mortar};
}

void run_brick(const Operands& o) {
  o.each([&](int i) {
    const auto number = [&](int operand) { return o.number(operand, i); };
    const BrickShape shape{number(5),  number(6),  number(7),      number(8),     number(9),
                           number(10), number(11), o.at.choice[0], o.at.choice[1]};
    const Brick brick = brick_at(number(4) * o.vector(0, i), shape);
    const Rgb color = (1 - brick.tint) * o.vector(1, i) + brick.tint * o.vector(2, i);
    o.out()[i] = brick.mortar;
    o.set(1, i, color * (1 - brick.mortar) + o.vector(3, i) * brick.mortar);
  });
}

/// Sines of sines, `depth` times; each step folds one coordinate.
Rgb magic(const Vec3& place, float scale, float distortion, int depth, bool scaled_first) {
  const float before = scaled_first ? scale : 1.0f, after = scaled_first ? 5.0f : 5.0f * scale;
  const auto turn = [&](float p) { return std::fmod(p * before, kTwoPi); };
  const float px = turn(place.x), py = turn(place.y), pz = turn(place.z);
  float x = std::sin((px + py + pz) * after);
  float y = std::cos((-px + py - pz) * after);
  float z = -std::cos((-px - py + pz) * after);
  if (depth > 0) {
    x *= distortion;
    y *= distortion;
    z *= distortion;
  }
  for (int step = 1; step <= depth; ++step) {
    switch (step) {
      case 1:
        y = -std::cos(x - y + z) * distortion;
        break;
      case 2:
        x = std::cos(x - y - z) * distortion;
        break;
      case 3:
        z = std::sin(-x - y - z) * distortion;
        break;
      case 4:
        x = -std::cos(-x + y - z) * distortion;
        break;
      case 5:
        y = -std::sin(-x + y + z) * distortion;
        break;
      case 6:
        y = -std::cos(-x + y + z) * distortion;
        break;
      case 7:
        x = std::cos(x + y + z) * distortion;
        break;
      case 8:
        z = std::sin(x + y - z) * distortion;
        break;
      case 9:
        x = -std::cos(-x - y + z) * distortion;
        break;
      case 10:
        y = -std::sin(x - y + z) * distortion;
        break;
      default:
        break;
    }
  }
  const float width = distortion != 0 ? 2 * distortion : 1.0f;
  return Rgb(0.5f) - Rgb(x, y, z) / width;
}

}  // namespace

void run_patterns(const Operands& operands) {
  const Operands& o = operands;
  switch (o.at.operation) {
    case Operation::gradient:
      return o.each([&](int i) { o.out()[i] = saturated(gradient(o.choice<GradientKind>(0), o.vector(0, i))); });
    case Operation::checker:
      return o.each([&](int i) {
        const bool first = is_first_color(o.number(3, i) * o.vector(0, i));
        o.out()[i] = first ? 1.0f : 0.0f;
        o.set(1, i, o.vector(first ? 1 : 2, i));
      });
    case Operation::brick:
      return run_brick(o);
    case Operation::magic:
      return o.each([&](int i) {
        const Rgb color = magic(o.vector(0, i), o.number(1, i), o.number(2, i), o.at.choice[0], o.at.choice[1] != 0);
        o.out()[i] = (color.r + color.g + color.b) / 3;
        o.set(1, i, color);
      });
    default:
      return;
  }
}

}  // namespace velour
