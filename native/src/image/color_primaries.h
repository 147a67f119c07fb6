// Colors of other primaries, made linear Rec. 709.
#pragma once

#include <array>
#include <optional>
#include <span>

namespace velour {

/// CIE 1931 x, y of red, green, blue and white.
struct ColorPrimaries {
  std::array<double, 2> red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};  // Rec. 709, D65
};

/// CIE XYZ as a space of colors, as files state it.
inline constexpr ColorPrimaries kCieXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

using ColorMatrix = std::array<std::array<double, 3>, 3>;  // rows

/// From RGB of these primaries to linear Rec. 709. An RGB space's white becomes D65 (Bradford): what is neutral stays
/// neutral. CIE XYZ itself (primaries 1 0, 0 1, 0 0) states colors that no white adapts. Nothing where the primaries
/// are no basis of colors (three on a line, a white of no luminance, not finite).
std::optional<ColorMatrix> to_rec709(const ColorPrimaries& primaries);

/// Whether they say anything: Photoshop writes zeros where it does not know.
bool is_stated(const ColorPrimaries& primaries);

/// Whether they are Rec. 709's, to the digits that files write.
bool is_rec709(const ColorPrimaries& primaries);

/// Multiplies the first three of every `stride` values.
void transform_colors(const ColorMatrix& matrix, size_t stride, std::span<float> values);

}  // namespace velour
