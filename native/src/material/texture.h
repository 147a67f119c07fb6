// Pictures on surfaces, averaged over what a ray stands for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// What lies beyond the picture: itself again, its border, nothing (zero), itself mirrored. Blender's extensions.
enum class TextureWrap : int { repeat = 0, extend = 1, clip = 2, mirror = 3 };  // values of velour.h
/// Between texels, where they are larger than the ray's footprint; smaller ones are averaged whatever it says.
enum class TextureFilter : int { closest = 0, linear = 1 };  // values of velour.h

struct TextureOptions {
  TextureWrap wrap = TextureWrap::repeat;
  TextureFilter filter = TextureFilter::linear;
};

/// An immutable picture of T (float or Rgb, float32, linear) and its mip levels: each half as large as the one below,
/// rounded down, its texels exact means of the areas that they cover, so that every level has the picture's mean.
/// (0, 0) is the picture's lower left corner, (1, 1) its upper right. Thread-safe; no allocation after construction.
template <class T>
class Texture {
 public:
  /// `texels`: width x height, row 0 at the bottom; NaN counts as 0, infinity as the largest finite value. Throws
  /// Error(invalid_argument) when there are none, or not that many.
  Texture(int width, int height, std::vector<T> texels, const TextureOptions& options);

  /// About the mean over the parallelogram of the sides `footprint` (columns) about `uv`, both in texture coordinates:
  /// trilinear look-ups at the places of footprint_taps. A coordinate that is not finite counts as 0.
  T look_up(const Vec2& uv, const Mat2& footprint) const;

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }
  uint64_t bytes() const;

 private:
  struct Level {
    int width, height;
    std::vector<T> texels;
  };
  static Level half(const Level& level);
  int wrapped(int i, int size) const;
  T texel(const Level& level, int x, int y) const;
  T closest(const Vec2& uv) const;
  T bilinear(const Level& level, const Vec2& uv) const;
  T trilinear(const Vec2& uv, float level) const;
  Vec2 reduced(const Vec2& uv) const;

  TextureOptions options_;
  std::vector<Level> levels_;
};

extern template class Texture<float>;
extern template class Texture<Rgb>;

}  // namespace velour
