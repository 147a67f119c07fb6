#include "image/tensors/tensor_pixels.h"

#include <Imath/half.h>

#include <algorithm>
#include <cstring>

namespace velour {
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
