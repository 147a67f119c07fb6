// How tensors and packs lie in the parts of OpenEXR files.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfPixelType.h>

#include <string>
#include <vector>

#include "image/tensor.h"

namespace velour {

using ChannelNames = std::vector<std::string>;

struct PartSize {
  uint64_t width = 1, height = 1, channels = 1;
};

/// Of a tensor.
PartSize part_size(std::vector<uint64_t> shape);

/// Blender makes room for the first part's pixels and writes every other part there, row by row of the first one's
/// width: what is wider or higher lies beside it.
bool covers(const PartSize& first, const PartSize& part);

/// The pixels of one part, as they are written. Keeps a reference to a tensor.
class TensorPixels {
 public:
  explicit TensorPixels(const Tensor& tensor);
  /// Of a pack, filled up with zeros, so that it covers `part`.
  TensorPixels(const std::vector<uint8_t>& pack, const PartSize& part);

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

/// OpenEXR's view of row-major pixels of a type. It takes mutable pointers for reading and writing alike.
Imf::FrameBuffer pixel_buffer(const char* data, Imf::PixelType type, const PartSize& size, const ChannelNames& names);

/// Of parts that viewers show.
ChannelNames shown_names(uint64_t channels);
/// Of packs and of parts that the first one does not cover: Blender 3.4 leaves out channels of names that it does not
/// know. In the order of the alphabet, in which they are stored.
ChannelNames hidden_names(uint64_t channels);

}  // namespace velour
