// Textures, averaged over ray footprints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

/// Values beyond the image: repeated, border texels, zero, mirrored. Blender's extension modes.
enum class TextureWrap : int { repeat = 0, extend = 1, clip = 2, mirror = 3 };  // values of velour.h
/// Interpolation of texels that are larger than the ray's footprint; smaller ones are always averaged.
enum class TextureFilter : int { closest = 0, linear = 1 };  // values of velour.h

struct TextureOptions {
  TextureWrap wrap = TextureWrap::repeat;
  TextureFilter filter = TextureFilter::linear;
};

/// An immutable image of T (float or Rgb, float32, linear) and its mip levels. Each level is half as large as the one
/// below, rounded down, and its texels are exact means of the areas they cover, so every level has the image's mean.
/// (0, 0) is the lower left corner of the image, (1, 1) the upper right. Thread-safe; no allocation after construction.
template <class T>
class Texture {
 public:
  /// `texels`: width x height, row 0 at the bottom; NaN counts as 0, infinity as the largest finite value. Throws
  /// Error(invalid_argument) if there are none or their number differs.
  Texture(int width, int height, std::vector<T> texels, const TextureOptions& options);

  /// Approximate mean over the parallelogram with sides `footprint` (columns) about `uv`, both in texture coordinates,
  /// from trilinear look-ups at footprint_taps(). A coordinate that is not finite counts as 0.
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
