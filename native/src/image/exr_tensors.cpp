#include "image/exr_tensors.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "image/exr_errors.h"
#include "image/exr_scan.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr char kShapeAttribute[] = "velour.shape";
constexpr size_t kMaxRank = 16;
constexpr int kZipLevel = 6;  // written out, because the library's default may change and the bytes must not

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const uint8_t> bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char target[], int count) override {
    const auto wanted = static_cast<uint64_t>(std::max(count, 0));
    if (position_ > bytes_.size() || wanted > bytes_.size() - position_)
      throw Error(Status::bad_data, std::string(fileName()) + ": ends at byte " + std::to_string(bytes_.size()) +
                                        " inside its pixels; it is truncated or damaged.");
    std::memcpy(target, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  std::span<const uint8_t> bytes_;
  uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("memory") {}

  void write(const char source[], int count) override {
    const uint64_t end = position_ + static_cast<uint64_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, source, static_cast<size_t>(count));
    position_ = end;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<uint8_t> bytes_;
  uint64_t position_ = 0;
};

/// How a tensor lies in a part.
struct PartSize {
  uint64_t width = 1, height = 1, channels = 1;
};

PartSize part_size(std::vector<uint64_t> shape) {
  PartSize size;
  if (!shape.empty() && shape.back() == 3) {
    size.channels = 3;
    shape.pop_back();
  }
  if (shape.empty()) return size;
  size.width = shape.back();
  shape.pop_back();
  for (const uint64_t extent : shape) size.height *= extent;
  return size;
}

using ChannelNames = std::vector<std::string>;

/// Of parts that viewers show.
ChannelNames shown_names(uint64_t channels) { return channels == 3 ? ChannelNames{"R", "G", "B"} : ChannelNames{"Y"}; }

/// Of parts that reach beyond the first one. Blender 3.4 makes room for the first part's pixels and writes all others
/// there, past its end; channels of names that it does not know it leaves out. In the order of the alphabet, in which
/// they are stored.
ChannelNames hidden_names(uint64_t channels) {
  return channels == 3 ? ChannelNames{"value_x", "value_y", "value_z"} : ChannelNames{"value"};
}

/// Those of a part that there is.
ChannelNames names_in(const Imf::Header& header, uint64_t channels) {
  const ChannelNames hidden = hidden_names(channels);
  return header.channels().findChannel(hidden[0]) ? hidden : shown_names(channels);
}

/// Number of elements, or 0 where an extent is 0 or the product does not fit.
uint64_t element_count(const std::vector<uint64_t>& shape) {
  uint64_t count = 1;
  for (const uint64_t extent : shape) {
    if (extent == 0 || count > (uint64_t{1} << 40) / extent) return 0;
    count *= extent;
  }
  return count;
}

std::string shape_text(const std::vector<uint64_t>& shape) {
  if (shape.empty()) return "scalar";
  std::string text = std::to_string(shape[0]);
  for (size_t i = 1; i < shape.size(); ++i) text.append(" ").append(std::to_string(shape[i]));
  return text;
}

std::vector<uint64_t> parse_shape(const std::string& text, const std::string& where) {
  std::vector<uint64_t> shape;
  if (text == "scalar") return shape;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end && shape.size() < kMaxRank) {
    const auto result = std::from_chars(at, end, shape.emplace_back());
    if (result.ec != std::errc()) break;
    at = result.ptr;
    if (at == end) return shape;
    if (*at++ != ' ') break;
  }
  throw Error(Status::bad_data,
              where + "velour.shape is '" + text + "'; it must be up to 16 extents, as in '90 90 180'.");
}

void check_tensor(const std::string& name, const Tensor& tensor) {
  const uint64_t count = element_count(tensor.shape);
  if (count == 0 || count != tensor.data.size() || tensor.shape.size() > kMaxRank)
    throw Error(Status::invalid_argument, "Tensor '" + name + "' of shape '" + shape_text(tensor.shape) + "' has " +
                                              std::to_string(tensor.data.size()) + " values.");
  for (const float value : tensor.data)
    if (tensor.half && rounded_to_half(value) != value)
      throw Error(Status::invalid_argument, "Tensor '" + name + "' is to be stored as half floats, which cannot hold " +
                                                std::to_string(value) + "; round it first.");
  const PartSize size = part_size(tensor.shape);
  constexpr uint64_t kMaxLine = INT32_MAX / (4 * 16 * 3);  // a chunk's bytes are an int in OpenEXR
  if (size.width > kMaxLine || size.height > INT32_MAX / 2)
    throw Error(Status::invalid_argument,
                "Tensor '" + name + "' of shape '" + shape_text(tensor.shape) + "' is too long for OpenEXR.");
}

/// `first`: the first part's window, empty for that one.
Imf::Header make_header(const std::string& name, const Tensor& tensor, const Imath::Box2i& first) {
  const PartSize size = part_size(tensor.shape);
  const Imath::Box2i window({0, 0}, {static_cast<int>(size.width) - 1, static_cast<int>(size.height) - 1});
  const bool shown = first.isEmpty() || (first.intersects(window.min) && first.intersects(window.max));
  Imf::Header header(first.isEmpty() ? window : first, window);
  header.setName(name);
  header.setType(Imf::SCANLINEIMAGE);
  header.compression() = Imf::ZIP_COMPRESSION;  // a chunk that does not get smaller is stored as it is
  header.zipCompressionLevel() = kZipLevel;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709
  header.insert(kShapeAttribute, Imf::StringAttribute(shape_text(tensor.shape)));
  for (const auto& channel : shown ? shown_names(size.channels) : hidden_names(size.channels))
    header.channels().insert(channel, Imf::Channel(tensor.half ? Imf::HALF : Imf::FLOAT));
  return header;
}

/// All parts share the first one's display window, as OpenEXR asks; the data windows differ.
std::vector<Imf::Header> make_headers(const TensorFile& file) {
  std::vector<Imf::Header> headers;
  for (const auto& [name, tensor] : file.tensors) {
    check_tensor(name, tensor);
    headers.push_back(make_header(name, tensor, headers.empty() ? Imath::Box2i() : headers[0].displayWindow()));
  }
  for (const auto& [key, value] : file.attributes) headers.at(0).insert(key, Imf::StringAttribute(value));
  return headers;
}

constexpr Imf::PixelType pixel_type(const float*) { return Imf::FLOAT; }
constexpr Imf::PixelType pixel_type(const half*) { return Imf::HALF; }

/// OpenEXR's view of row-major values.
template <typename Value>
Imf::FrameBuffer frame_buffer(Value* data, const PartSize& size, const ChannelNames& names) {
  Imf::FrameBuffer buffer;
  const size_t x_stride = sizeof(Value) * size.channels, y_stride = x_stride * size.width;
  for (size_t c = 0; c < names.size(); ++c)
    buffer.insert(names[c], Imf::Slice(pixel_type(data), reinterpret_cast<char*>(data + c), x_stride, y_stride));
  return buffer;
}

void write_part(Imf::OutputPart part, const Tensor& tensor) {
  const PartSize size = part_size(tensor.shape);
  const ChannelNames names = names_in(part.header(), size.channels);
  // OpenEXR converts what it reads, not what it writes.
  const std::vector<half> halves(tensor.data.begin(), tensor.half ? tensor.data.end() : tensor.data.begin());
  // Slice takes a mutable pointer for reading and writing alike; nothing is written through it here.
  part.setFrameBuffer(tensor.half ? frame_buffer(const_cast<half*>(halves.data()), size, names)
                                  : frame_buffer(const_cast<float*>(tensor.data.data()), size, names));
  part.writePixels(static_cast<int>(size.height));
}

void write_parts(Imf::MultiPartOutputFile& out, const TensorFile& file) {
  int index = 0;
  for (const auto& [name, tensor] : file.tensors) write_part(Imf::OutputPart(out, index++), tensor);
}

/// The shape of a scanned part, agreed with its pixels.
std::vector<uint64_t> checked_shape(const ExrPart& part, const std::string& name) {
  const std::string where = name + ": part '" + part.name + "': ";
  auto shape = parse_shape(part.shape, where);
  const uint64_t count = element_count(shape);
  const PartSize size = count == 0 ? PartSize{0, 0, 0} : part_size(shape);
  if (count == 0 || size.width != part.width || size.height != part.height || size.channels != part.channels.size())
    throw Error(Status::bad_data, where + "velour.shape '" + part.shape + "' does not match " +
                                      std::to_string(part.width) + " x " + std::to_string(part.height) + " pixels of " +
                                      std::to_string(part.channels.size()) + " channels.");
  return shape;
}

void read_attributes(const Imf::Header& header, std::map<std::string, std::string>& attributes) {
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string key = it.name();
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text && key.starts_with("velour.") && key != kShapeAttribute) attributes.emplace(key, text->value());
  }
}

Tensor read_part(Imf::MultiPartInputFile& in, int index, const ExrPart& scanned, const std::string& name) {
  Tensor tensor{checked_shape(scanned, name), {}, scanned.value_bytes == sizeof(half)};
  const PartSize size = part_size(tensor.shape);
  const ChannelNames names = names_in(in.header(index), size.channels);
  for (const auto& channel : names)
    if (!in.header(index).channels().findChannel(channel))
      throw Error(Status::bad_data, name + ": part '" + scanned.name + "': channel " + channel + " is missing.");
  tensor.data.resize(scanned.value_count());
  Imf::InputPart part(in, index);
  part.setFrameBuffer(frame_buffer(tensor.data.data(), size, names));
  part.readPixels(0, static_cast<int>(size.height) - 1);
  return tensor;
}

TensorFile decode_scanned(std::span<const uint8_t> bytes, const std::vector<ExrPart>& parts, const std::string& name) {
  MemoryInput stream(bytes, name);
  // No threads of OpenEXR's own: its pool is global to the process. No repair of chunk tables: a damaged file is
  // refused.
  Imf::MultiPartInputFile in(stream, 0, false);
  TensorFile file;
  for (int i = 0; i < in.parts() && static_cast<size_t>(i) < parts.size(); ++i) {
    const ExrPart& part = parts[static_cast<size_t>(i)];
    read_attributes(in.header(i), file.attributes);
    if (!part.shape.empty()) file.tensors[part.name] = read_part(in, i, part, name);
  }
  return file;
}

}  // namespace

float rounded_to_half(float value) { return half(value); }

std::vector<uint8_t> encode_tensors(const TensorFile& file) {
  if (file.tensors.empty()) throw Error(Status::invalid_argument, "A file of tensors needs at least one tensor.");
  const auto headers = make_headers(file);
  MemoryOutput stream;
  const auto sentence = [](const char* why) { return std::string("OpenEXR cannot encode the tensors: ") + why; };
  with_exr_errors(Status::unknown, sentence, [&] {
    Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
    write_parts(out, file);
  });
  return stream.take();
}

TensorFile decode_tensors(std::span<const uint8_t> bytes, const std::string& name) {
  const auto parts = scan_exr(bytes, name);
  const auto sentence = [&](const char* why) { return name + ": OpenEXR refuses the file: " + why; };
  return with_exr_errors(Status::bad_data, sentence, [&] { return decode_scanned(bytes, parts, name); });
}

bool looks_like_exr(std::span<const uint8_t> head) {
  constexpr uint8_t kMagic[] = {0x76, 0x2f, 0x31, 0x01};
  return head.size() >= 4 && std::memcmp(head.data(), kMagic, 4) == 0;
}

}  // namespace velour
