// Reads PNG and JPEG files and encodes PNG files through the module that links OpenImageIO.
#include "base/error.h"
#include "base/private_library.h"
#include "image/open_picture.h"
#include "image/openimageio/openimageio_module.h"

namespace velour {
namespace {

const OpenImageIoModule& open_module() {
  // Never closed: unloading 260 libraries at exit takes time, and OpenImageIO's threads may still be running.
  static const auto& library = *new PrivateLibrary(
      "libvelour_openimageio.so",
      "run scripts/setup and scripts/build again, or use an OpenEXR file, which does not require OpenImageIO.");
  return *library.function<decltype(velour_openimageio_2)>("velour_openimageio_2")();
}

/// The first call opens the module. After a failure the next call tries again.
const OpenImageIoModule& module_for(const std::string& path) {
  try {
    static const OpenImageIoModule& module = open_module();
    return module;
  } catch (const Error& error) {
    throw Error(error.status(), path + ": requires OpenImageIO, but " + error.what());
  }
}

const char* reader_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::png:
      return "png";
    case PictureFormat::jpeg:
      return "jpeg";
    case PictureFormat::bmp:
    case PictureFormat::tiff:
    case PictureFormat::exr:
    case PictureFormat::radiance:
      break;
  }
  throw Error(Status::invalid_argument, "OpenImageIO is not used for this format.");
}

class ByOpenImageIo : public OpenPicture {
 public:
  ByOpenImageIo(const std::string& path, PictureFormat format) : path_(path), module_(module_for(path)) {
    std::string error;
    file_ = module_.open(path, reader_of(format), error);
    if (file_ == nullptr) throw Error(Status::bad_data, input_error(path, error));
    header_ = module_.header(*file_);
    header_.orientation = exif_orientation(format, path);
    header_.note_color_space(path, other_color_space(format, path));
  }
  ~ByOpenImageIo() override { module_.close(file_); }
  ByOpenImageIo(const ByOpenImageIo&) = delete;
  ByOpenImageIo& operator=(const ByOpenImageIo&) = delete;

  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string& name) const override { return module_.text(*file_, name); }
  void read(std::span<float> values) override {
    std::string error;
    if (!module_.read(*file_, values, error)) throw Error(Status::bad_data, input_error(path_, error));
  }

 private:
  std::string path_;
  const OpenImageIoModule& module_;
  OpenImageIoModule::File* file_;
  PictureHeader header_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_integers(const std::string& path, PictureFormat format) {
  return std::make_unique<ByOpenImageIo>(path, format);
}

std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values) {
  std::string error;
  auto bytes = module_for(path).encode_png(width, height, channels, values, error);
  if (!error.empty()) throw Error(Status::unsupported, path + ": OpenImageIO cannot write the image: " + error);
  return bytes;
}

}  // namespace velour
