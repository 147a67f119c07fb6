#include "image/portable/portable_picture.h"

#include "base/error.h"
#include "image/open_picture.h"

namespace velour {
namespace {

/// Adds the orientation and the warning about the color space, which the libraries do not report.
class WithOrientation : public OpenPicture {
 public:
  WithOrientation(std::unique_ptr<OpenPicture> picture, PictureFormat format, const std::string& path)
      : picture_(std::move(picture)), header_(picture_->header()) {
    header_.orientation = exif_orientation(format, path);
    header_.note_color_space(path, other_color_space(format, path));
  }
  const PictureHeader& header() const override { return header_; }
  std::optional<std::string> text(const std::string& name) const override { return picture_->text(name); }
  void read(std::span<float> values) override { picture_->read(values); }

 private:
  std::unique_ptr<OpenPicture> picture_;
  PictureHeader header_;
};

std::unique_ptr<OpenPicture> open_format(const std::string& path, PictureFormat format) {
  switch (format) {
    case PictureFormat::png:
      return open_by_stb(path);
    case PictureFormat::jpeg:
      return open_jpeg(path);
    case PictureFormat::bmp:
    case PictureFormat::tiff:
    case PictureFormat::exr:
    case PictureFormat::radiance:
      break;
  }
  throw Error(Status::invalid_argument, path + ": is not an integer image.");
}

}  // namespace

std::unique_ptr<OpenPicture> open_integers(const std::string& path, PictureFormat format) {
  return std::make_unique<WithOrientation>(open_format(path, format), format, path);
}

}  // namespace velour
