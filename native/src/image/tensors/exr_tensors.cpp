#include "image/tensors/exr_tensors.h"

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
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "image/formats/exr_header_check.h"
#include "image/formats/exr_scan.h"
#include "image/tensors/tensor_pack.h"

namespace velour {
namespace {

constexpr char kShapeAttribute[] = "velour.shape", kCodingAttribute[] = "velour.coding", kPack[] = "pack";
constexpr int kZipLevel = 6;  // explicit, because the library's default may change but the bytes must not

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const uint8_t> bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char target[], int count) override {
    const auto wanted = static_cast<uint64_t>(std::max(count, 0));
    if (position_ > bytes_.size() || wanted > bytes_.size() - position_)
      throw Error(Status::bad_data, std::string(fileName()) + ": ends at byte " + std::to_string(bytes_.size()) +
                                        " within its pixels; it is truncated or damaged.");
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

/// The hidden or the shown names, whichever the part has.
ChannelNames names_in(const Imf::Header& header, uint64_t channels) {
  const ChannelNames hidden = hidden_names(channels);
  return header.channels().findChannel(hidden[0]) ? hidden : shown_names(channels);
}

std::vector<uint64_t> parse_shape(const std::string& text, const std::string& where) {
  std::vector<uint64_t> shape;
  if (text == "scalar") return shape;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end && shape.size() < kMaxTensorRank) {
    const auto result = std::from_chars(at, end, shape.emplace_back());
    if (result.ec != std::errc()) break;
    at = result.ptr;
    if (at == end) return shape;
    if (*at++ != ' ') break;
  }
  throw Error(Status::bad_data,
              where + "velour.shape is '" + text + "'; it must be up to 16 extents, for example '90 90 180'.");
}

/// Throws Error(invalid_argument) if a part exceeds OpenEXR's limits.
void check_size(const std::string& name, const PartSize& size) {
  constexpr uint64_t kMaxLine = INT32_MAX / (4 * 16 * 3);  // a chunk's bytes are an int in OpenEXR
  if (size.width > kMaxLine || size.height > INT32_MAX / 2)
    throw Error(Status::invalid_argument, "Tensor '" + name + "' is too large for OpenEXR.");
}

Imath::Box2i window_of(const PartSize& size) {
  return {{0, 0}, {static_cast<int>(size.width) - 1, static_cast<int>(size.height) - 1}};
}

/// `first`: the size of the first part.
Imf::Header make_header(const std::string& name, const TensorPixels& pixels, const PartSize& first) {
  const PartSize& size = pixels.size();
  const bool is_pack = pixels.type() == Imf::UINT;
  Imf::Header header(window_of(first), window_of(size));
  header.setName(name);
  header.setType(Imf::SCANLINEIMAGE);
  header.compression() = is_pack ? Imf::NO_COMPRESSION : Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709
  const bool shown = !is_pack && covers(first, size);
  for (const auto& channel : shown ? shown_names(size.channels) : hidden_names(size.channels))
    header.channels().insert(channel, Imf::Channel(pixels.type()));
  return header;
}

/// The parts of a file, from tensors that must outlive it. All share the first part's display window, as OpenEXR
/// requires; their data windows differ.
class PartList {
 public:
  void add(const std::string& name, const Tensor& tensor) {
    if (tensor.precision == Precision::bytes)
      throw Error(Status::invalid_argument, "Tensor '" + name + "' of bytes can only be written to a packed file.");
    add_pixels(name, TensorPixels(tensor));
    headers_.back().insert(kShapeAttribute, Imf::StringAttribute(shape_text(tensor.shape)));
  }

  /// Adds a pack padded to cover `part`.
  void add_pack(const std::vector<uint8_t>& pack, const PartSize& part) {
    add_pixels(kPack, TensorPixels(pack, part));
    headers_.back().insert(kCodingAttribute, Imf::StringAttribute(kPack));
  }

  void describe(const std::map<std::string, std::string>& attributes) {
    for (const auto& [key, value] : attributes) headers_.at(0).insert(key, Imf::StringAttribute(value));
  }

  std::vector<uint8_t> encoded() const {
    MemoryOutput stream;
    const auto sentence = [](const char* why) { return std::string("OpenEXR cannot encode the tensors: ") + why; };
    with_exr_errors(Status::unknown, sentence, [&] {
      Imf::MultiPartOutputFile out(stream, headers_.data(), static_cast<int>(headers_.size()), false, 0);
      for (size_t i = 0; i < pixels_.size(); ++i) write_part({out, static_cast<int>(i)}, pixels_[i]);
    });
    return stream.take();
  }

 private:
  void add_pixels(const std::string& name, TensorPixels pixels) {
    check_size(name, pixels.size());
    pixels_.push_back(std::move(pixels));
    headers_.push_back(make_header(name, pixels_.back(), pixels_.front().size()));
  }

  static void write_part(Imf::OutputPart part, const TensorPixels& pixels) {
    part.setFrameBuffer(pixels.frame_buffer(names_in(part.header(), pixels.size().channels)));
    part.writePixels(static_cast<int>(pixels.size().height));
  }

  std::vector<Imf::Header> headers_;
  std::vector<TensorPixels> pixels_;
};

bool is_open(const std::string& text) { return text.size() <= kLongestOpenText; }

/// Name of the smallest tensor that OpenEXR has a type for; the first if there are several.
const std::string& open_tensor(const TensorFile& file) {
  const auto values = [](const auto& named) {
    return named.second.precision == Precision::bytes ? SIZE_MAX : named.second.data.size();
  };
  const auto smallest = std::min_element(file.tensors.begin(), file.tensors.end(),
                                         [&](const auto& a, const auto& b) { return values(a) < values(b); });
  if (smallest->second.precision == Precision::bytes)
    throw Error(Status::invalid_argument, "A packed file must have at least one tensor of floats or halves.");
  return smallest->first;
}

/// Adds one tensor and short attributes in plain form, and the rest as a pack, which comes first because it covers the
/// tensor.
void add_packed(const TensorFile& file, PartList& parts) {
  const std::string& name = open_tensor(file);
  const Tensor& tensor = file.tensors.at(name);
  TensorFile pack{{}, file.tensors};
  pack.tensors.erase(name);
  std::map<std::string, std::string> open;
  for (const auto& [key, text] : file.attributes) (is_open(text) ? open : pack.attributes).emplace(key, text);
  parts.add_pack(encode_pack(pack), part_size(tensor.shape));
  parts.add(name, tensor);
  parts.describe(open);
}

/// Name of the first tensor that covers all others; of the first one if there is none.
const std::string& covering_tensor(const TensorFile& file) {
  PartSize all;
  for (const auto& [name, tensor] : file.tensors) {
    const PartSize size = part_size(tensor.shape);
    all = {std::max(all.width, size.width), std::max(all.height, size.height)};
  }
  const auto covering = std::find_if(file.tensors.begin(), file.tensors.end(),
                                     [&](const auto& named) { return covers(part_size(named.second.shape), all); });
  return (covering == file.tensors.end() ? file.tensors.begin() : covering)->first;
}

void add_all(const TensorFile& file, PartList& parts) {
  const std::string& first = covering_tensor(file);
  parts.add(first, file.tensors.at(first));
  for (const auto& [name, tensor] : file.tensors)
    if (name != first) parts.add(name, tensor);
  parts.describe(file.attributes);
}

/// The shape of a scanned part, checked against its pixels.
std::vector<uint64_t> checked_shape(const ExrPart& part, const std::string& where) {
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
    if (text && key.starts_with("velour.") && key != kShapeAttribute && key != kCodingAttribute) {
      attributes.emplace(key, text->value());
    }
  }
}

template <typename Value>
std::vector<Value> read_pixels(Imf::MultiPartInputFile& in, int index, Imf::PixelType type, const ExrPart& scanned,
                               const std::string& where) {
  const ChannelNames names = names_in(in.header(index), scanned.channels.size());
  for (const auto& channel : names)
    if (!in.header(index).channels().findChannel(channel))
      throw Error(Status::bad_data, where + "channel " + channel + " is missing.");
  std::vector<Value> values(scanned.value_count());
  const PartSize size{scanned.width, scanned.height, names.size()};
  Imf::InputPart part(in, index);
  part.setFrameBuffer(pixel_buffer(reinterpret_cast<const char*>(values.data()), type, size, names));
  part.readPixels(0, static_cast<int>(size.height) - 1);
  return values;
}

Tensor read_tensor(Imf::MultiPartInputFile& in, int index, const ExrPart& part, const std::string& where) {
  if (part.integers)
    throw Error(Status::bad_data, where + "has integer channels instead of float channels; the file is damaged.");
  const auto precision = part.value_bytes == sizeof(half) ? Precision::halves : Precision::floats;
  auto shape = checked_shape(part, where);
  return {std::move(shape), read_pixels<float>(in, index, Imf::FLOAT, part, where), precision};
}

/// Tracks the remaining memory while parts are read.
class Budget {
 public:
  Budget(const TensorLimits& limits, uint64_t file_bytes)
      : known_(limits.known), left_(limits.max_bytes), file_bytes_(file_bytes) {}

  bool takes(const std::string& tensor) const {
    return known_.empty() ||
           std::ranges::any_of(known_, [&](std::string_view begin) { return tensor.starts_with(begin); });
  }
  uint64_t left() const { return left_; }
  void take(uint64_t bytes, const std::string& where) {
    if (bytes > left_) {
      throw Error(Status::bad_data, where + "it would take " + std::to_string(bytes >> 20) +
                                        " MiB of memory, too much for a file of " + std::to_string(file_bytes_ >> 10) +
                                        " KiB; the file is damaged or malicious.");
    }
    left_ -= bytes;
  }
  /// A pack is already compressed, so the file cannot be much smaller.
  void check_pack(uint64_t bytes, const std::string& where) const {
    constexpr uint64_t kTimes = 4, kAlways = 1 << 20;
    if (bytes > kAlways + kTimes * file_bytes_)
      throw Error(Status::bad_data, where + "is damaged or malicious: it would fill the memory.");
  }

 private:
  const std::vector<std::string_view>& known_;
  uint64_t left_, file_bytes_;
};

TensorFile read_pack(Imf::MultiPartInputFile& in, int index, const ExrPart& part, const std::string& where,
                     const Budget& budget) {
  if (!part.integers || part.channels.size() != 1)
    throw Error(Status::bad_data, where + "is not a single integer channel; the file is damaged.");
  budget.check_pack(part.value_count() * sizeof(uint32_t), where);
  const auto words = read_pixels<uint32_t>(in, index, Imf::UINT, part, where);
  return decode_pack({reinterpret_cast<const uint8_t*>(words.data()), words.size() * sizeof(uint32_t)},
                     where + "packed data",
                     {[&](const std::string& name) { return budget.takes(name); }, budget.left()});
}

void merge(TensorFile from, TensorFile& file) {
  file.attributes.merge(from.attributes);
  file.tensors.merge(from.tensors);
}

TensorFile decode_scanned(std::span<const uint8_t> bytes, const std::vector<ExrPart>& parts, const std::string& name,
                          Budget budget) {
  MemoryInput stream(bytes, name);
  // No OpenEXR threads, because its pool is global to the process. No repair of chunk tables: damaged files are
  // refused.
  Imf::MultiPartInputFile in(stream, 0, false);
  TensorFile file;
  for (int i = 0; i < in.parts() && static_cast<size_t>(i) < parts.size(); ++i) {
    const ExrPart& part = parts[static_cast<size_t>(i)];
    read_attributes(in.header(i), file.attributes);
    const std::string where = name + ": part '" + part.name + "': ";
    if (!part.shape.empty() && budget.takes(part.name)) {
      budget.take(part.value_count() * sizeof(float), where);
      file.tensors[part.name] = read_tensor(in, i, part, where);
    }
    if (part.coding == kPack) {
      merge(read_pack(in, i, part, where, budget), file);
      file.packed = true;
    }
  }
  return file;
}

}  // namespace

std::vector<uint8_t> encode_tensors(const TensorFile& file) {
  if (file.tensors.empty()) throw Error(Status::invalid_argument, "A tensor file must have at least one tensor.");
  for (const auto& [name, tensor] : file.tensors) check_tensor(name, tensor);
  PartList parts;
  file.packed ? add_packed(file, parts) : add_all(file, parts);
  return parts.encoded();
}

TensorFile decode_tensors(std::span<const uint8_t> bytes, const std::string& name, const TensorLimits& limits) {
  const auto parts = scan_exr(bytes, name);
  const auto sentence = [&](const char* why) { return name + ": OpenEXR cannot read the file: " + why; };
  return with_exr_errors(Status::bad_data, sentence,
                         [&] { return decode_scanned(bytes, parts, name, Budget(limits, bytes.size())); });
}

bool looks_like_exr(std::span<const uint8_t> head) {
  constexpr uint8_t kBegin[] = {0x76, 0x2f, 0x31, 0x01};
  return head.size() >= 4 && std::memcmp(head.data(), kBegin, 4) == 0;
}

}  // namespace velour
