#include "image/tensors/tensor_pack.h"

#include <Imath/half.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>

#include "base/error.h"
#include "base/json_fields.h"

namespace velour {

namespace {

constexpr int kLevel = 6, kWindowBits = 15, kMemoryLevel = 8;  // explicit: the same bytes must give the same stream
constexpr size_t kStep = 1 << 16;

/// zlib's counters have 32 bits.
uInt counted(uint64_t bytes) {
  if (bytes <= UINT32_MAX) return static_cast<uInt>(bytes);
  throw Error(Status::invalid_argument, "More than 4 GiB cannot be compressed at once.");
}

/// zlib takes non-const pointers, but only reads through them.
Bytef* source(std::span<const uint8_t> bytes) { return const_cast<Bytef*>(bytes.data()); }

}  // namespace

Deflater::Deflater() {
  if (deflateInit2(&stream_, kLevel, Z_DEFLATED, kWindowBits, kMemoryLevel, strategy_) != Z_OK) throw std::bad_alloc();
}

Deflater::~Deflater() { deflateEnd(&stream_); }

void Deflater::write(std::span<const uint8_t> bytes, int strategy) {
  if (strategy != strategy_) change_to(strategy);
  stream_.next_in = source(bytes);
  stream_.avail_in = counted(bytes.size());
  run(Z_NO_FLUSH);
}

std::vector<uint8_t> Deflater::take() {
  run(Z_FINISH);
  out_.resize(stream_.total_out);
  return std::move(out_);
}

void Deflater::run(int flush) {
  do {
    make_room();
    if (deflate(&stream_, flush) == Z_STREAM_ERROR) throw Error(Status::unknown, "zlib cannot compress the data.");
  } while (stream_.avail_out == 0);
}

void Deflater::change_to(int strategy) {
  run(Z_BLOCK);  // flushes the last block, for which deflateParams would need room
  make_room();
  if (deflateParams(&stream_, kLevel, strategy) != Z_OK) throw Error(Status::unknown, "zlib cannot compress the data.");
  strategy_ = strategy;
}

void Deflater::make_room() {
  out_.resize(stream_.total_out + kStep);
  stream_.next_out = out_.data() + stream_.total_out;
  stream_.avail_out = kStep;
}

Inflater::Inflater(std::span<const uint8_t> bytes) {
  stream_.next_in = source(bytes);
  stream_.avail_in = counted(bytes.size());
  if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
}

Inflater::~Inflater() { inflateEnd(&stream_); }

bool Inflater::read(std::span<uint8_t> to) {
  if (to.size() > UINT32_MAX) return false;
  stream_.next_out = to.data();
  stream_.avail_out = static_cast<uInt>(to.size());
  const int status = inflate(&stream_, Z_SYNC_FLUSH);
  return (status == Z_OK || status == Z_STREAM_END) && stream_.avail_out == 0;
}

bool Inflater::finish() {
  uint8_t beyond = 0;
  stream_.next_out = &beyond;
  stream_.avail_out = 1;
  return inflate(&stream_, Z_SYNC_FLUSH) == Z_STREAM_END && stream_.avail_out == 1;
}

namespace {

using Json = JsonFields::Json;

constexpr float kOfByte = 1.0f / 256;  // multiplying a byte by it is exact
constexpr std::array kNames = {"float", "half", "byte"};
constexpr std::array<uint64_t, 3> kValueBytes = {4, 2, 1};
constexpr uint64_t kMaxTensors = 4096;

uint64_t value_bytes(Precision precision) { return kValueBytes[static_cast<size_t>(precision)]; }

std::string list_of(const TensorFile& file) {
  Json tensors = Json::array();
  for (const auto& [name, tensor] : file.tensors) {
    const char* const values = kNames[static_cast<size_t>(tensor.precision)];
    tensors.push_back({{"name", name}, {"values", values}, {"shape", tensor.shape}});
  }
  const Json list = {{"texts", file.attributes}, {"tensors", tensors}};
  return list.dump(-1, ' ', false, Json::error_handler_t::replace);
}

uint32_t bits_of(float value, Precision precision) {
  return precision == Precision::halves ? half(value).bits() : std::bit_cast<uint32_t>(value);
}

float value_of(uint32_t bits, Precision precision) {
  if (precision == Precision::floats) return std::bit_cast<float>(bits);
  half value;
  value.setBits(static_cast<uint16_t>(bits));
  return value;
}

/// All highest bytes, then all next lower ones, and so on.
std::vector<uint8_t> planes_of(const Tensor& tensor) {
  std::vector<uint8_t> planes;
  for (uint64_t plane = value_bytes(tensor.precision); plane-- > 0;) {
    for (const float value : tensor.data) {
      planes.push_back(static_cast<uint8_t>(bits_of(value, tensor.precision) >> 8 * plane));
    }
  }
  return planes;
}

std::vector<float> values_of(const std::vector<uint8_t>& planes, Precision precision) {
  const size_t count = planes.size() / value_bytes(precision);
  std::vector<float> values(count);
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits = 0;
    for (size_t at = i; at < planes.size(); at += count) bits = bits << 8 | planes[at];
    values[i] = value_of(bits, precision);
  }
  return values;
}

std::vector<uint8_t> rests_of(const Tensor& maps) {
  std::vector<uint8_t> bytes(maps.data.size());
  std::transform(maps.data.begin(), maps.data.end(), bytes.begin(),
                 [](float value) { return static_cast<uint8_t>(value / kOfByte); });
  maps_to_rests(bytes, maps.shape.end()[-2], maps.shape.back());
  return bytes;
}

std::vector<float> values_of_rests(std::vector<uint8_t> rests, const std::vector<uint64_t>& shape) {
  rests_to_maps(rests, shape.end()[-2], shape.back());
  std::vector<float> values(rests.size());
  std::transform(rests.begin(), rests.end(), values.begin(), [](uint8_t byte) { return byte * kOfByte; });
  return values;
}

std::vector<uint64_t> shape_in(const JsonFields& fields) {
  const Json& list = fields.at("shape");
  const auto is_extent = [](const Json& json) { return json.is_number_unsigned(); };
  if (!list.is_array() || list.size() > kMaxTensorRank || !std::all_of(list.begin(), list.end(), is_extent))
    fields.fail("shape", "a list of at most 16 integers");
  return list.get<std::vector<uint64_t>>();
}

Precision precision_in(const JsonFields& fields) {
  const auto found = std::find(kNames.begin(), kNames.end(), fields.text("values"));
  if (found == kNames.end()) fields.fail("values", "float, half or byte");
  return static_cast<Precision>(found - kNames.begin());
}

/// Reads the list at the beginning of a stream, then the values that it lists.
class PackReader {
 public:
  PackReader(std::span<const uint8_t> bytes, const std::string& where, const PackLimits& limits)
      : source_{where, "the file is damaged. Copy it again, or create it again."},
        limits_(limits),
        inflater_(bytes),
        left_(std::min(kMaxInflated * bytes.size(), limits.max_bytes)),
        memory_left_(limits.max_bytes) {}

  TensorFile read() {
    const Json list = parse_json(read_list());
    if (!list.is_object()) damaged();
    const JsonFields fields(list, source_);
    TensorFile file;
    read_texts(fields, file);
    read_tensors(fields, file);
    if (!inflater_.finish()) damaged();
    return file;
  }

 private:
  [[noreturn]] void damaged() const {
    throw Error(Status::bad_data, source_.name + ": the file is damaged. Copy it again, or create it again.");
  }

  std::vector<uint8_t> take(uint64_t count) {
    if (count > left_) damaged();
    left_ -= count;
    std::vector<uint8_t> bytes(count);
    if (!inflater_.read(bytes)) damaged();
    return bytes;
  }

  std::vector<uint8_t> read_list() {
    const std::vector<uint8_t> count = take(4);
    return take(count[0] | uint64_t{count[1]} << 8 | uint64_t{count[2]} << 16 | uint64_t{count[3]} << 24);
  }

  void read_texts(const JsonFields& fields, TensorFile& file) const {
    const Json& texts = fields.at("texts");
    if (!texts.is_object()) fields.fail("texts", "an object");
    const JsonFields each(texts, source_, "texts.");
    for (const auto& item : texts.items()) file.attributes[item.key()] = each.text(item.key().c_str());
  }

  void read_tensors(const JsonFields& fields, TensorFile& file) {
    const Json& tensors = fields.at("tensors");
    if (!tensors.is_array() || tensors.size() > kMaxTensors) fields.fail("tensors", "a list of at most 4096 objects");
    for (const Json& json : tensors) {
      if (!json.is_object()) fields.fail("tensors", "a list of objects");
      const JsonFields tensor(json, source_, "tensors.");
      const std::string name = tensor.text("name");
      if (limits_.takes && !limits_.takes(name)) {
        skip(count_of(tensor) * value_bytes(precision_in(tensor)));
      } else {
        file.tensors[name] = read_tensor(tensor);
      }
    }
  }

  void skip(uint64_t count) {
    constexpr uint64_t kBlock = 1 << 16;
    for (; count > 0; count -= std::min(count, kBlock)) take(std::min(count, kBlock));
  }

  uint64_t count_of(const JsonFields& fields) const {
    const std::vector<uint64_t> shape = shape_in(fields);
    const uint64_t count = element_count(shape);
    const bool is_maps = precision_in(fields) == Precision::bytes;
    if (count == 0 || (is_maps && shape.size() < 2))
      fields.fail("shape", "a valid shape without zeros (of at least two dimensions for bytes)");
    return count;
  }

  Tensor read_tensor(const JsonFields& fields) {
    Tensor tensor{shape_in(fields), {}, precision_in(fields)};
    const uint64_t count = count_of(fields);
    const bool is_maps = tensor.precision == Precision::bytes;
    if (count > memory_left_ / sizeof(float)) damaged();
    memory_left_ -= count * sizeof(float);
    std::vector<uint8_t> bytes = take(count * value_bytes(tensor.precision));
    tensor.data = is_maps ? values_of_rests(std::move(bytes), tensor.shape) : values_of(bytes, tensor.precision);
    return tensor;
  }

  JsonSource source_;
  const PackLimits& limits_;
  Inflater inflater_;
  uint64_t left_;         // remaining bytes that may come out of the stream
  uint64_t memory_left_;  // remaining bytes that tensors may take
};

}  // namespace

std::vector<uint8_t> encode_pack(const TensorFile& file) {
  const std::string list = list_of(file);
  std::array<uint8_t, 4> count;
  for (size_t i = 0; i < count.size(); ++i) count[i] = static_cast<uint8_t>(list.size() >> 8 * i);
  Deflater deflater;
  deflater.write(count);
  deflater.write({reinterpret_cast<const uint8_t*>(list.data()), list.size()});
  for (const auto& [name, tensor] : file.tensors) {
    if (tensor.precision == Precision::bytes) {
      deflater.write_rests(rests_of(tensor));
    } else {
      deflater.write(planes_of(tensor));
    }
  }
  return deflater.take();
}

TensorFile decode_pack(std::span<const uint8_t> bytes, const std::string& where, const PackLimits& limits) {
  return PackReader(bytes, where, limits).read();
}

namespace {

/// Predicts byte `x` of `row`. `below`: the row below, or null.
uint8_t guess(const uint8_t* row, const uint8_t* below, uint64_t x) {
  if (x == 0) return below ? below[0] : 0;
  if (!below) return row[x - 1];
  const int left = row[x - 1], under = below[x], corner = below[x - 1];
  return static_cast<uint8_t>(std::clamp(left + under - corner, std::min(left, under), std::max(left, under)));
}

}  // namespace

void maps_to_rests(std::span<uint8_t> maps, uint64_t rows, uint64_t columns) {
  // Runs from the last byte to the first, so that predictions use bytes, not residuals.
  for (uint64_t line = maps.size() / columns; line-- > 0;) {
    uint8_t* const row = maps.data() + line * columns;
    const uint8_t* const below = line % rows == 0 ? nullptr : row - columns;
    for (uint64_t x = columns; x-- > 0;) row[x] = static_cast<uint8_t>(row[x] - guess(row, below, x));
  }
}

void rests_to_maps(std::span<uint8_t> rests, uint64_t rows, uint64_t columns) {
  for (uint64_t line = 0; line < rests.size() / columns; ++line) {
    uint8_t* const row = rests.data() + line * columns;
    const uint8_t* const below = line % rows == 0 ? nullptr : row - columns;
    for (uint64_t x = 0; x < columns; ++x) row[x] = static_cast<uint8_t>(row[x] + guess(row, below, x));
  }
}

namespace {

/// Row length of packs in words: OpenEXR's overhead is a three-thousandth of such a row, and every GPU accepts pictures
/// of this width.
constexpr uint64_t kLongestRow = 1 << 14;

/// Size of a part for `words`, with as little padding as covering `part` allows.
PartSize words_size(uint64_t words, const PartSize& part) {
  PartSize size;
  size.height = std::max(part.height, (words + kLongestRow - 1) / kLongestRow);
  size.width = std::max(part.width, (words + size.height - 1) / size.height);
  return size;
}

size_t value_bytes(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

}  // namespace

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

TensorPixels::TensorPixels(const Tensor& tensor)
    : size_(part_size(tensor.shape)), data_(reinterpret_cast<const char*>(tensor.data.data())) {
  if (tensor.precision == Precision::floats) return;
  // OpenEXR converts values when it reads, but not when it writes.
  for (const float value : tensor.data) halves_.push_back(half(value).bits());
  type_ = Imf::HALF;
  data_ = reinterpret_cast<const char*>(halves_.data());
}

bool covers(const PartSize& first, const PartSize& part) {
  return part.width <= first.width && part.height <= first.height;
}

TensorPixels::TensorPixels(const std::vector<uint8_t>& pack, const PartSize& part)
    : size_(words_size((pack.size() + sizeof(uint32_t) - 1) / sizeof(uint32_t), part)), type_(Imf::UINT) {
  words_.resize(size_.width * size_.height);
  std::memcpy(words_.data(), pack.data(), pack.size());
  data_ = reinterpret_cast<const char*>(words_.data());
}

Imf::FrameBuffer TensorPixels::frame_buffer(const ChannelNames& names) const {
  return pixel_buffer(data_, type_, size_, names);
}

Imf::FrameBuffer pixel_buffer(const char* data, Imf::PixelType type, const PartSize& size, const ChannelNames& names) {
  Imf::FrameBuffer buffer;
  const size_t bytes = value_bytes(type), x_stride = bytes * size.channels, y_stride = x_stride * size.width;
  for (size_t c = 0; c < names.size(); ++c) {
    buffer.insert(names[c], Imf::Slice(type, const_cast<char*>(data) + c * bytes, x_stride, y_stride));
  }
  return buffer;
}

ChannelNames shown_names(uint64_t channels) { return channels == 3 ? ChannelNames{"R", "G", "B"} : ChannelNames{"Y"}; }

ChannelNames hidden_names(uint64_t channels) {
  return channels == 3 ? ChannelNames{"value_x", "value_y", "value_z"} : ChannelNames{"value"};
}

}  // namespace velour
