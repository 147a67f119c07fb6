// Blender's color nodes (kernel/svm/color_util.h, hsv.h, ramp.h and util/color.h of Cycles).
#include <algorithm>
#include <cmath>
#include "material/program/operands.h"

namespace velour {
namespace {

// Hue, saturation and value or lightness [Smi78].

/// Hue in [0, 1) of a color whose brightest and darkest channels are `most` and `least`; they differ.
float hue_of(const Rgb& c, float most, float least) {
  const float range = most - least;
  float sixths;
  if (c.r == most) {
    sixths = (c.g - c.b) / range;
  } else if (c.g == most) {
    sixths = 2 + (c.b - c.r) / range;
  } else {
    sixths = 4 + (c.r - c.g) / range;
  }
  const float hue = sixths / 6;
  return hue < 0 ? hue + 1 : hue;
}

Vec3 hsv_of(const Rgb& c) {
  const float most = std::max({c.r, c.g, c.b}), least = std::min({c.r, c.g, c.b});
  const float saturation = ratio(most - least, most);
  return {saturation != 0 ? hue_of(c, most, least) : 0.0f, saturation, most};
}

Rgb rgb_of_hsv(const Vec3& hsv) {
  const float s = hsv.y, v = hsv.z;
  if (s == 0) return Rgb(v);
  const float sixths = (hsv.x == 1 ? 0.0f : hsv.x) * 6, sector = std::floor(sixths), f = sixths - sector;
  const float p = v * (1 - s), q = v * (1 - s * f), t = v * (1 - s * (1 - f));
  if (sector == 0) return {v, t, p};
  if (sector == 1) return {q, v, p};
  if (sector == 2) return {p, v, t};
  if (sector == 3) return {p, q, v};
  if (sector == 4) return {t, p, v};
  return {v, p, q};
}

Vec3 hsl_of(const Rgb& c) {
  const float most = std::max({c.r, c.g, c.b}), least = std::min({c.r, c.g, c.b});
  const float lightness = std::min(1.0f, (most + least) / 2);
  if (most == least) return {0, 0, lightness};
  const float saturation = (most - least) / (lightness > 0.5f ? 2 - most - least : most + least);
  return {hue_of(c, most, least), saturation, lightness};
}

Rgb rgb_of_hsl(const Vec3& hsl) {
  const float chroma = (1 - std::abs(2 * hsl.z - 1)) * hsl.y, sixths = hsl.x * 6;
  const Rgb pure(saturated(std::abs(sixths - 3) - 1), saturated(2 - std::abs(sixths - 2)),
                 saturated(2 - std::abs(sixths - 4)));
  return (pure - 0.5f) * chroma + hsl.z;
}

Rgb to_rgb(ColorModel model, const Vec3& c) {
  return model == ColorModel::hsv ? rgb_of_hsv(c) : model == ColorModel::hsl ? rgb_of_hsl(c) : c;
}
Vec3 from_rgb(ColorModel model, const Rgb& c) {
  return model == ColorModel::hsv ? hsv_of(c) : model == ColorModel::hsl ? hsl_of(c) : c;
}

// Blends of a color with another, by a factor t.

float screened(float t, float a, float b) { return 1 - (1 - t + t * (1 - b)) * (1 - a); }

float overlaid(float t, float a, float b) {
  return a < 0.5f ? a * (1 - t + 2 * t * b) : 1 - (1 - t + 2 * t * (1 - b)) * (1 - a);
}

float dodged(float t, float a, float b) {
  if (a == 0) return 0;
  const float left = 1 - t * b;
  return left <= 0 ? 1.0f : std::min(a / left, 1.0f);
}

float burnt(float t, float a, float b) {
  const float left = 1 - t + t * b;
  return left <= 0 ? 0.0f : saturated(1 - (1 - a) / left);
}

float soft_lit(float t, float a, float b) {
  const float screen = 1 - (1 - b) * (1 - a);
  return (1 - t) * a + t * ((1 - a) * b * a + a * screen);
}

float blended(BlendMode mode, float t, float a, float b) {
  switch (mode) {
    case BlendMode::mix:
      return mixed(a, b, t);
    case BlendMode::darken:
      return mixed(a, std::min(a, b), t);
    case BlendMode::multiply:
      return a * (1 - t + t * b);
    case BlendMode::burn:
      return burnt(t, a, b);
    case BlendMode::lighten:
      return mixed(a, std::max(a, b), t);
    case BlendMode::screen:
      return screened(t, a, b);
    case BlendMode::dodge:
      return dodged(t, a, b);
    case BlendMode::add:
      return a + t * b;
    case BlendMode::overlay:
      return overlaid(t, a, b);
    case BlendMode::soft_light:
      return soft_lit(t, a, b);
    case BlendMode::linear_light:
      return a + t * (2 * b - 1);
    case BlendMode::difference:
      return mixed(a, std::abs(a - b), t);
    case BlendMode::exclusion:
      return std::max(mixed(a, a + b - 2 * a * b, t), 0.0f);
    case BlendMode::subtract:
      return a - t * b;
    case BlendMode::divide:
      return b != 0 ? (1 - t) * a + t * a / b : a;
    default:
      return a;
  }
}

/// Blends of hue, saturation and value.
Rgb recolored(BlendMode mode, float t, const Rgb& a, const Rgb& b) {
  Vec3 hsv = hsv_of(a);
  const Vec3 other = hsv_of(b);
  switch (mode) {
    case BlendMode::hue:
      return other.y != 0 ? glm::mix(a, rgb_of_hsv({other.x, hsv.y, hsv.z}), t) : a;
    case BlendMode::color:
      return other.y != 0 ? glm::mix(a, rgb_of_hsv({other.x, other.y, hsv.z}), t) : a;
    case BlendMode::saturation:
      return hsv.y != 0 ? rgb_of_hsv({hsv.x, (1 - t) * hsv.y + t * other.y, hsv.z}) : a;
    default:
      return rgb_of_hsv({hsv.x, hsv.y, (1 - t) * hsv.z + t * other.z});
  }
}

void run_mix_color(const Operands& o) {
  const auto mode = o.choice<BlendMode>(0);
  const bool clamps_factor = o.at.choice[1] != 0, clamps = o.at.choice[2] != 0;
  const auto factor = [&](int i) { return clamps_factor ? saturated(o.number(0, i)) : o.number(0, i); };
  if (mode >= BlendMode::hue) {
    o.each([&](int i) { o.set(0, i, recolored(mode, factor(i), o.vector(1, i), o.vector(2, i))); });
  } else {
    for (int c = 0; c < 3; ++c) {
      o.each([&](int i) { o.out(c)[i] = blended(mode, factor(i), o.in(1, c)[i], o.in(2, c)[i]); });
    }
  }
  for (int c = 0; c < 3 && clamps; ++c) o.each([&](int i) { o.out(c)[i] = saturated(o.out(c)[i]); });
}

void run_mix_values(const Operands& o, int components) {
  const bool clamps = o.at.choice[0] != 0;
  for (int c = 0; c < components; ++c) {
    const float *t = o.in(0, c), *a = o.in(1, c), *b = o.in(2, c);
    o.each([&](int i) { o.out(c)[i] = mixed(a[i], b[i], clamps ? saturated(t[i]) : t[i]); });
  }
}

// Tables of ramps and curves.

/// Value at `place`, 0 for the first and 1 for the last of `rows` rows of `width` values: column `column`.
float looked_up(const float* table, int rows, int width, int column, float place, bool interpolates) {
  const float at = saturated(place) * static_cast<float>(rows - 1);
  const int row = std::clamp(static_cast<int>(at), 0, rows - 1);  // also if `place` is not a number
  const float share = at - static_cast<float>(row), value = table[row * width + column];
  return interpolates && share > 0 ? (1 - share) * value + share * table[(row + 1) * width + column] : value;
}

/// The same, continued along the line through the two rows at either end.
float extended(const float* table, int rows, int width, int column, float place) {
  if (!(place < 0 || place > 1)) return looked_up(table, rows, width, column, place, true);
  const int end = place < 0 ? 0 : rows - 1, beside = place < 0 ? 1 : rows - 2;
  const float value = table[end * width + column], beyond = place < 0 ? -place : place - 1;
  return value + (value - table[beside * width + column]) * beyond * static_cast<float>(rows - 1);
}

void run_ramp(const Operands& o) {
  const int rows = static_cast<int>(o.at.table_size / 4);
  const bool interpolates = o.at.choice[0] != 0;
  for (int c = 0; c < 4; ++c) {
    o.each([&](int i) { o.out(c)[i] = looked_up(o.table, rows, 4, c, o.number(0, i), interpolates); });
  }
}

void run_curves(const Operands& o) {
  const int rows = static_cast<int>(o.at.table_size / 3);
  const bool extends = o.at.choice[0] != 0;
  for (int c = 0; c < 3; ++c) {
    o.each([&](int i) {
      const float factor = o.number(0, i), value = o.in(1, c)[i], low = o.number(2, i);
      const float place = ratio(value - low, o.number(3, i) - low);
      const float curve = extends ? extended(o.table, rows, 3, c, place) : looked_up(o.table, rows, 3, c, place, true);
      o.out(c)[i] = (1 - factor) * value + factor * curve;
    });
  }
}

// Adjustments of one color.

Rgb adjusted(const Rgb& color, float hue, float saturation, float value, float factor) {
  Vec3 hsv = hsv_of(color);
  hsv = {fraction(hsv.x + hue + 0.5f), saturated(hsv.y * saturation), hsv.z * value};
  return glm::max(factor * rgb_of_hsv(hsv) + (1 - factor) * color, Rgb(0.0f));
}

float raised(float value, float gamma) {
  if (gamma == 0) return 1;
  return value > 0 ? std::pow(value, gamma) : value;
}

template <class F>
void each_channel(const Operands& o, int color, const F& f) {
  for (int c = 0; c < 3; ++c) o.each([&](int i) { o.out(c)[i] = f(o.in(color, c)[i], i); });
}

}  // namespace

void run_color(const Operands& operands) {
  const Operands& o = operands;
  switch (o.at.operation) {
    case Operation::mix_color:
      return run_mix_color(o);
    case Operation::mix_number:
      return run_mix_values(o, 1);
    case Operation::mix_vector:
      return run_mix_values(o, 3);
    case Operation::combine:
      return o.each([&](int i) {
        o.set(0, i, to_rgb(o.choice<ColorModel>(0), {o.number(0, i), o.number(1, i), o.number(2, i)}));
      });
    case Operation::separate:
      return o.each([&](int i) { o.set(0, i, from_rgb(o.choice<ColorModel>(0), o.vector(0, i))); });
    case Operation::ramp:
      return run_ramp(o);
    case Operation::curves:
      return run_curves(o);
    case Operation::hue_saturation:
      return o.each([&](int i) {
        o.set(0, i, adjusted(o.vector(4, i), o.number(0, i), o.number(1, i), o.number(2, i), o.number(3, i)));
      });
    case Operation::invert:
      return each_channel(o, 1, [&](float value, int i) {
        const float factor = o.number(0, i);
        return factor * (1 - value) + (1 - factor) * value;
      });
    case Operation::gamma:
      return each_channel(o, 0, [&](float value, int i) { return raised(value, o.number(1, i)); });
    case Operation::bright_contrast:
      return each_channel(o, 0, [&](float value, int i) {
        const float bright = o.number(1, i), contrast = o.number(2, i);
        return std::max((1 + contrast) * value + bright - contrast * 0.5f, 0.0f);
      });
    default:
      return;
  }
}

}  // namespace velour
