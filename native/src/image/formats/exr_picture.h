// Chooses the channels of an OpenEXR file that make up the picture, by their names, never by their order.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace velour {

struct ExrColors {
  enum class Kind {
    gray,
    rgb,              // or X, Y, Z, taken as they are
    luminance_chroma  // Y, RY, BY
  };
  Kind kind = Kind::rgb;
  std::array<std::string, 3> names;   // of red, green, blue; for gray, the first; empty: absent, which counts as 0
  std::string alpha;                  // empty: none
  std::string layer;                  // of the channels; empty: none
  std::vector<std::string> left_out;  // all other channels

  bool operator==(const ExrColors&) const = default;
};

/// `layer`: the name of a layer ("sky", "ViewLayer.Combined"), the end of one ("Combined"), or one channel ("depth.Z").
/// Empty: the channels without a layer; else the only layer with colors; else the only one named Combined, RGB, RGBA or
/// Beauty; else the only channel. Channel names are case-insensitive: R, G, B, A or red, green, blue, alpha; Y; Y, RY,
/// BY; X, Y, Z. Throws Error(unsupported) if the choice is ambiguous or there is no such layer, naming `path`, the
/// channels and how to choose.
ExrColors choose_exr_colors(std::span<const std::string> channels, const std::string& layer, const std::string& path);

}  // namespace velour
