// The interface of libvelour_openimageio.so, which reads and writes pictures with OpenImageIO. It is opened for the
// first picture that needs it: OpenImageIO brings some 260 libraries, and loading them takes longer than most commands.
#pragma once

#include "image/open_picture.h"

namespace velour {

/// No exception and no virtual call crosses this boundary, because each side has its own type information. Errors are
/// returned as texts.
struct OpenImageIoModule {
  struct File;
  /// Opens with the reader of that name ("png") only. Returns null and sets `error` for a file that it cannot read.
  File* (*open)(const std::string& path, const char* reader, std::string& error);
  void (*close)(File* file);
  PictureHeader (*header)(const File& file);
  std::optional<std::string> (*text)(const File& file, const std::string& name);
  /// Like OpenPicture::read. Returns false and sets `error` for a file that ends early.
  bool (*read)(File& file, std::span<float> values, std::string& error);
  /// Like png_of(). Sets `error` if OpenImageIO cannot write the picture.
  std::vector<uint8_t> (*encode_png)(int width, int height, int channels, std::span<const uint8_t> values,
                                     std::string& error);
};

}  // namespace velour

/// The only symbol that the module exports. Raise its number with every change of the struct: a program that is running
/// while Velour is rebuilt opens the new module.
extern "C" const velour::OpenImageIoModule* velour_openimageio_2();
