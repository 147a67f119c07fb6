// Textures, and parameters of materials that may come from one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>
#include "material/surface_site.h"
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

/// Texels as Cycles keeps an image's: it interpolates these, divides by alpha, and decodes what it gets, so an edge in
/// an sRGB image is darker than the mean of its sides (kernel/svm/image.h, svm_image_texture).
struct StoredTexels {
  std::vector<glm::vec4> texels;  // color and alpha
  bool srgb = false;              // colors have the sRGB curve
  bool premultiplied = false;     // interpolated colors are divided by alpha, unless that is 0
  Mat3 colors{1.0f};              // from decoded colors to those of the texture; a number is the first of them
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
  /// The finest level is interpolated before it is decoded; the others are means of decoded texels, by their alpha if
  /// they are premultiplied, so that mean colors times mean alpha are the mean of what is seen.
  Texture(int width, int height, StoredTexels texels, const TextureOptions& options);

  /// Approximate mean over the parallelogram with sides `footprint` (columns) about `uv`, both in texture coordinates,
  /// from trilinear look-ups at footprint_taps(). A coordinate that is not finite counts as 0.
  T look_up(const Vec2& uv, const Mat2& footprint) const;
  /// Interpolated texels of the image itself, as Cycles reads it.
  T at_point(const Vec2& uv) const { return look_up(uv, Mat2(0.0f)); }

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }
  uint64_t bytes() const;

 private:
  struct Level {
    int width, height;
    std::vector<T> texels;       // times their weights, if there are any
    std::vector<float> weights;  // of premultiplied texels
  };
  struct Weighted {
    T value;  // times weight
    float weight;
    T mean() const { return weight > 0.0f ? value / weight : T(0.0f); }
  };
  static Level half(const Level& level);
  void add_levels();
  int wrapped(int i, int size) const;
  template <class V>
  V at(const std::vector<V>& texels, const Level& level, int x, int y) const;
  glm::vec4 stored(int x, int y) const;
  T decoded(const glm::vec4& stored) const;
  Weighted weighted(const glm::vec4& stored) const;
  T closest(const Vec2& uv) const;
  Weighted bilinear(const Level& level, const Vec2& uv) const;
  Weighted trilinear(const Vec2& uv, float level) const;
  Vec2 reduced(const Vec2& uv) const;

  TextureOptions options_;
  std::vector<Level> levels_;          // without the texels of the finest, if they are in stored_
  StoredTexels stored_;                // in 8 bits if that loses nothing
  std::vector<glm::u8vec4> of_bytes_;  // texels of stored_, times 255
};

extern template class Texture<float>;
extern template class Texture<Rgb>;

// A texture, a mesh's own colors or an output of a program in place of a number or a color of a material.

class Program;

// Affine map of texture coordinates: places an image or a tile on a surface.

/// Maps (u, v) of a surface to `map` (u, v) + `shift`.
struct TextureMap {
  Mat2 map{1.0f};
  Vec2 shift{0.0f};

  Vec2 point(const Vec2& uv) const { return map * uv + shift; }
  /// A singular map leaves no direction for a tangent and no width for a footprint.
  bool invertible() const {
    const float sum = map[0].x + map[0].y + map[1].x + map[1].y + shift.x + shift.y;
    return std::isfinite(sum) && glm::determinant(glm::dmat2(map)) != 0.0;
  }
};

/// The color, or its first channel.
template <class T>
T first_of(const Rgb& color) {
  if constexpr (std::is_same_v<T, Rgb>)
    return color;
  else
    return color.r;
}

/// If empty, the parameter's own value applies.
template <class T>
struct TextureSlot {
  std::shared_ptr<const Texture<T>> texture;
  TextureMap map;           // from the surface's coordinates to the image's
  size_t set;               // set of coordinates (SurfaceSite::place) or of mesh colors, or output of the program
  bool of_corners = false;  // use the mesh's colors (SurfaceSite::colors); a number takes the first channel
  std::shared_ptr<const Program> program{};  // use what it computed (SurfaceSite::computed)

  // Not an aggregate: GCC 12 warns about uninitialized members of aggregates in braced lists.
  TextureSlot(std::shared_ptr<const Texture<T>> picture = nullptr, const TextureMap& to_picture = {},
              size_t of_surface = 0) noexcept
      : texture(std::move(picture)), map(to_picture), set(of_surface) {}
  static TextureSlot colors_of_corners(size_t set) {
    TextureSlot slot(nullptr, {}, set);
    slot.of_corners = true;
    return slot;
  }

  static TextureSlot output_of(std::shared_ptr<const Program> computing, size_t output) {
    TextureSlot slot(nullptr, {}, output);
    slot.program = std::move(computing);
    return slot;
  }

  bool given() const { return texture || of_corners || program; }

  T at(const SurfaceSite& site, const T& otherwise) const {
    if (program) return first_of<T>(site.computed[set]);
    if (of_corners) return first_of<T>(site.colors[set]);
    if (!texture) return otherwise;
    const SitePlace place = site.place(set);
    return texture->look_up(map.point(place.uv), map.map * place.footprint);
  }
  /// Not averaged over the footprint, which would bias what is not linear in the texture.
  T at_point(const SurfaceSite& site, const T& otherwise) const {
    return texture ? texture->at_point(map.point(site.place(set).uv)) : at(site, otherwise);
  }
};

/// What a material needs of a site: numbers of texture coordinate sets and corner color sets of a mesh, and a program.
struct MeshSets {
  uint8_t uvs = 0, colors = 0;
  std::shared_ptr<const Program> program{};
  uint32_t outputs = 0;  // of the program that are used, as bits

  /// Throw Error(invalid_argument) if both need a program and these differ.
  void add(const MeshSets& other) {
    uvs = std::max(uvs, other.uvs);
    colors = std::max(colors, other.colors);
    if (other.program) use(other.program, other.outputs);
  }
  template <class T>
  void add(const TextureSlot<T>& slot) {
    if (slot.program) {
      use(slot.program, uint32_t{1} << slot.set);
    } else if (slot.given()) {
      uint8_t& count = slot.of_corners ? colors : uvs;
      count = std::max(count, static_cast<uint8_t>(1 + slot.set));
    }
  }

 private:
  void use(const std::shared_ptr<const Program>& computing, uint32_t used);
};

}  // namespace velour
