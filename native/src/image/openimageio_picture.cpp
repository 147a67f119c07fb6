// Pictures of all formats but OpenEXR's, by OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "image/open_picture.h"
#include "job/error.h"

namespace velour {
namespace {

class ByOpenImageIo : public OpenPicture {
 public:
  explicit ByOpenImageIo(const std::string& path) : path_(path) {
    OIIO::ImageSpec request;
    request.attribute("oiio:UnassociatedAlpha",
                      1);  // channels as stored: no product with alpha before the sRGB curve
    input_ = OIIO::ImageInput::open(path, &request);
    if (!input_) throw Error(Status::bad_data, input_error(path, OIIO::geterror()));
  }

  Format format() const override {
    const OIIO::ImageSpec& spec = input_->spec();
    return {spec.width, spec.height, spec.depth, spec.nchannels, !spec.format.is_floating_point(), spec.alpha_channel};
  }

  std::optional<std::string> text(const std::string& name) const override {
    const OIIO::ParamValue* found = input_->spec().find_attribute(name, OIIO::TypeDesc::STRING);
    return found ? std::optional(found->get_string()) : std::nullopt;
  }

  void read(std::span<float> values) override {
    const bool read = input_->read_image(0, 0, 0, input_->spec().nchannels, OIIO::TypeDesc::FLOAT, values.data());
    // Of a JPEG or TIFF that ends early it says so, and that all is well.
    if (!read || input_->has_error()) throw Error(Status::bad_data, input_error(path_, input_->geterror()));
  }

 private:
  std::string path_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

}  // namespace

std::unique_ptr<OpenPicture> open_other_format(const std::string& path) {
  return std::make_unique<ByOpenImageIo>(path);
}

std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  auto output = OIIO::ImageOutput::create(path);
  if (!output) throw Error(Status::unsupported, path + ": OpenImageIO cannot write this format here.");
  output->set_ioproxy(&memory);
  if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::UINT8, values.data()) || !output->close())
    throw Error(Status::io, path + ": cannot encode the picture: " + output->geterror());
  return bytes;
}

}  // namespace velour
