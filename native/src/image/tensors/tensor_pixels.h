// Layout of tensors and packs in the parts of OpenEXR files.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfPixelType.h>

#include <string>
#include <vector>

#include "image/tensors/tensor.h"

namespace velour {

using ChannelNames = std::vector<std::string>;

struct PartSize {
  uint64_t width = 1, height = 1, channels = 1;
};

/// Size of the part for a tensor.
PartSize part_size(std::vector<uint64_t> shape);

/// Whether `part` fits into `first`. Blender allocates a buffer for the first part's pixels and reads every other part
/// into it with the first one's row width, so a wider or higher part would exceed it.
bool covers(const PartSize& first, const PartSize& part);

/// The pixels of one part in the form in which they are written. The tensor must outlive it. Not copied, because it may
/// point to pixels of its own.
class TensorPixels {
 public:
  explicit TensorPixels(const Tensor& tensor);
  /// The pixels of a pack, padded with zeros to cover `part`.
  TensorPixels(const std::vector<uint8_t>& pack, const PartSize& part);
  TensorPixels(TensorPixels&&) = default;
  TensorPixels& operator=(TensorPixels&&) = default;

  const PartSize& size() const { return size_; }
  Imf::PixelType type() const { return type_; }
  Imf::FrameBuffer frame_buffer(const ChannelNames& names) const;

 private:
  PartSize size_;
  Imf::PixelType type_ = Imf::FLOAT;
  std::vector<uint16_t> halves_;
  std::vector<uint32_t> words_;
  const char* data_ = nullptr;
};

/// Frame buffer over row-major pixels. OpenEXR takes mutable pointers for reading and writing alike.
Imf::FrameBuffer pixel_buffer(const char* data, Imf::PixelType type, const PartSize& size, const ChannelNames& names);

/// Channel names of parts that viewers show.
ChannelNames shown_names(uint64_t channels);
/// Channel names of packs and of parts that the first one does not cover: Blender 3.4 ignores channels with unknown
/// names. In alphabetical order, in which they are stored.
ChannelNames hidden_names(uint64_t channels);

}  // namespace velour
