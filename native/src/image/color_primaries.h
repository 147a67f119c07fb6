// Conversion of colors with other primaries to linear Rec. 709.
#pragma once

#include <array>
#include <optional>
#include <span>

namespace velour {

/// CIE 1931 chromaticities x, y of red, green, blue and white.
struct ColorPrimaries {
  std::array<double, 2> red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};  // Rec. 709, D65
};

/// CIE XYZ as a color space, as files state it.
inline constexpr ColorPrimaries kCieXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

using ColorMatrix = std::array<std::array<double, 3>, 3>;  // rows

/// Matrix from RGB with these primaries to linear Rec. 709. The white of an RGB space is adapted to D65 (Bradford), so
/// that neutral colors stay neutral; CIE XYZ (primaries 1 0, 0 1, 0 0) is not adapted. Empty if the primaries are not a
/// basis (collinear, a white without luminance, or not finite).
std::optional<ColorMatrix> to_rec709(const ColorPrimaries& primaries);

/// Whether any value is set: Photoshop writes zeros for unknown primaries.
bool is_stated(const ColorPrimaries& primaries);

/// Whether the primaries are those of Rec. 709, to the precision with which files state them.
bool is_rec709(const ColorPrimaries& primaries);

/// Transforms the first three of every `stride` values in place.
void transform_colors(const ColorMatrix& matrix, size_t stride, std::span<float> values);

}  // namespace velour
