// What libvelour_openimageio.so offers: OpenImageIO, in a library that is opened with the first picture that needs it.
// OpenImageIO brings some 260 libraries, and loading them costs more than most commands.
#pragma once

#include "image/open_picture.h"

namespace velour {

/// Neither exceptions nor virtual functions cross over: each side has type information of its own. What goes wrong is
/// told by a text.
struct OpenImageIoModule {
  struct File;
  /// None, and the reason in `error`, for a file that OpenImageIO does not read.
  File* (*open)(const std::string& path, std::string& error);
  void (*close)(File* file);
  OpenPicture::Format (*format)(const File& file);
  std::optional<std::string> (*text)(const File& file, const std::string& name);
  /// As OpenPicture::read; false, and the reason in `error`, for a file that ends early.
  bool (*read)(File& file, std::span<float> values, std::string& error);
  /// As png_of(); no bytes, and the reason in `error`, where OpenImageIO cannot write them.
  std::vector<uint8_t> (*encode_png)(int width, int height, int channels, std::span<const uint8_t> values,
                                     std::string& error);
};

}  // namespace velour

/// The only symbol that the module exports. Another struct, another number: a program that runs while Velour is built
/// again finds the new module.
extern "C" const velour::OpenImageIoModule& velour_openimageio_1();
