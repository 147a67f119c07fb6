#include "image/openimageio/openimageio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace velour {

struct OpenImageIoModule::File {
  std::unique_ptr<OIIO::ImageInput> input;
};

namespace {

using File = OpenImageIoModule::File;

File* open(const std::string& path, const char* reader, std::string& error) {
  auto input = OIIO::ImageInput::create(reader);
  if (!input) {
    error = OIIO::geterror();
    return nullptr;
  }
  OIIO::ImageSpec request, spec;
  // Channels as stored: no multiplication by alpha before the sRGB curve.
  request.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->open(path, spec, request)) {
    error = input->geterror();
    return nullptr;
  }
  return new File{std::move(input)};
}

void close(File* file) { delete file; }

PictureHeader header(const File& file) {
  const OIIO::ImageSpec& spec = file.input->spec();
  PictureHeader header;
  header.width = spec.width;
  header.height = spec.height;
  header.depth = spec.depth;
  header.channels = spec.nchannels;
  header.integers = !spec.format.is_floating_point();
  header.alpha_channel = spec.alpha_channel;
  return header;
}

std::optional<std::string> text(const File& file, const std::string& name) {
  const OIIO::ParamValue* found = file.input->spec().find_attribute(name, OIIO::TypeDesc::STRING);
  return found ? std::optional(found->get_string()) : std::nullopt;
}

bool read(File& file, std::span<float> values, std::string& error) {
  OIIO::ImageInput& input = *file.input;
  const bool complete = input.read_image(0, 0, 0, input.spec().nchannels, OIIO::TypeDesc::FLOAT, values.data());
  // Reading a JPEG that ends early succeeds, but sets an error.
  if (complete && !input.has_error()) return true;
  error = input.geterror();
  return false;
}

std::vector<uint8_t> encode_png(int width, int height, int channels, std::span<const uint8_t> values,
                                std::string& error) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  auto output = OIIO::ImageOutput::create("png");
  if (!output) {
    error = OIIO::geterror();
    return {};
  }
  output->set_ioproxy(&memory);
  if (!output->open("memory.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, values.data()) ||
      !output->close()) {
    error = output->geterror();
    return {};
  }
  return bytes;
}

}  // namespace
}  // namespace velour

extern "C" __attribute__((visibility("default"))) const velour::OpenImageIoModule* velour_openimageio_2() {
  static constexpr velour::OpenImageIoModule kModule{velour::open, velour::close, velour::header,
                                                     velour::text, velour::read,  velour::encode_png};
  return &kModule;
}
