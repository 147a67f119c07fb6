// Pictures in OpenEXR files: parts of larger ones, and the channels that make up the colors.
#pragma once

#include <OpenEXR/ImfIO.h>
#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>
#include "base/file.h"
#include "image/picture.h"

namespace velour {

// OpenEXR files that contain a part of a larger picture.

/// Position of pixels in a larger picture: its size, and the position of their lower left pixel relative to its own.
struct PictureFrame {
  int width = 0, height = 0;
  int x = 0, y = 0;
  bool operator==(const PictureFrame&) const = default;
};

using PictureTexts = std::map<std::string, std::string>;  // by the attribute's name

/// Contents of the first part's header.
struct ExrHeader {
  int width = 0, height = 0;          // of the stored pixels (data window)
  std::vector<std::string> channels;  // in the order of read_picture_channels()
  PictureFrame frame;                 // position of the data window in the display window
  PictureTexts texts;
  bool multi_part = false;  // the file has further parts, which are not described here
};

/// Throws Error with the file's name; Error(bad_data) for another format.
ExrHeader read_exr_header(const std::string& path);

/// Like write_picture(), with a frame and texts. Throws Error(invalid_argument) if a text has the name of one of
/// OpenEXR's own attributes.
void write_exr_part(const std::string& path, const Picture& picture, const PictureFrame& frame,
                    const PictureTexts& texts);

// OpenEXR output stream into an AtomicFile.

class ExrOutput : public Imf::OStream {
 public:
  ExrOutput(AtomicFile& file, const std::string& path) : OStream(path.c_str()), file_(file) {}
  void write(const char source[], int count) override {
    file_.write({reinterpret_cast<const uint8_t*>(source), static_cast<size_t>(count)});
  }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { file_.seek(position); }

 private:
  AtomicFile& file_;
};

// Chooses the channels of an OpenEXR file that make up the picture, by their names, never by their order.

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
