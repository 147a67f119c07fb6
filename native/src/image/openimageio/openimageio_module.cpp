#include "image/openimageio/openimageio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string_view>

namespace velour {

struct OpenImageIoModule::File {
  std::string path;
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
  return new File{path, std::move(input)};
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

/// Whether an error is one of libjpeg's warnings that do not mean lost data (jpeg_picture.cpp has the others).
bool is_harmless(std::string_view error) {
  constexpr std::string_view kBegin = "JPEG error: ", kExtra = " extraneous bytes before marker ";
  constexpr std::string_view kHarmless[] = {
      "Invalid SOS parameters for sequential JPEG", "Unknown Adobe color transform", "Warning: unknown JFIF revision",
      "Corrupt JPEG data: bad ICC marker", "Application transferred too many scanlines"};
  if (!error.starts_with(kBegin)) return false;
  error.remove_prefix(kBegin.size());
  const auto begins = [&](std::string_view text) { return error.starts_with(text); };
  constexpr std::string_view kCorrupt = "Corrupt JPEG data: ";
  const size_t number_end = begins(kCorrupt) ? error.find_first_not_of("0123456789", kCorrupt.size()) : error.npos;
  return std::ranges::any_of(kHarmless, begins) ||
         (number_end != error.npos && error.substr(number_end).starts_with(kExtra));
}

/// Whether a JPEG file has the marker of its end after its last scan begins. OpenImageIO reports the first warning
/// only, which hides one about a missing end.
bool has_end(const std::string& path) {
  std::string bytes;
  if (!OIIO::Filesystem::read_text_file(path, bytes)) return false;
  const size_t scan = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
  return scan != bytes.npos && end != bytes.npos && end > scan;
}

bool read(File& file, std::span<float> values, std::string& error) {
  OIIO::ImageInput& input = *file.input;
  const bool complete = input.read_image(0, 0, 0, input.spec().nchannels, OIIO::TypeDesc::FLOAT, values.data());
  // Reading a JPEG that ends early succeeds, but sets an error.
  if (complete && !input.has_error()) return true;
  error = input.geterror();
  return complete && is_harmless(error) && has_end(file.path);
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
