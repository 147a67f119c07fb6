// Storage of tensors in the parts of OpenEXR files: lossless coding, packs, layout as pixels.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfPixelType.h>
#include <zlib.h>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>
#include "image/tensors/tensor.h"

namespace velour {

// Compression with zlib streams [RFC1950], which end with a checksum.

/// Maximum number of bytes that one byte of a stream expands to.
constexpr uint64_t kMaxInflated = 1032;

class Deflater {
 public:
  Deflater();
  ~Deflater();
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  /// For data with repetitions, such as text.
  void write(std::span<const uint8_t> bytes) { write(bytes, Z_DEFAULT_STRATEGY); }
  /// For residuals, which repeat only in runs and compress by the frequencies of their bytes.
  void write_rests(std::span<const uint8_t> bytes) { write(bytes, Z_RLE); }
  /// Ends and returns the stream; nothing can be written afterwards.
  std::vector<uint8_t> take();

 private:
  void write(std::span<const uint8_t> bytes, int strategy);
  void run(int flush);
  void change_to(int strategy);
  void make_room();

  z_stream stream_{};
  int strategy_ = Z_DEFAULT_STRATEGY;
  std::vector<uint8_t> out_;
};

class Inflater {
 public:
  /// `bytes` must outlive the Inflater; data after the stream's end are ignored.
  explicit Inflater(std::span<const uint8_t> bytes);
  ~Inflater();
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Fills `to`. Returns false if the stream is damaged or has fewer bytes left.
  bool read(std::span<uint8_t> to);
  /// Whether the stream has ended and its checksum is right.
  bool finish();

 private:
  z_stream stream_{};
};

// Tensors and texts in one zlib stream, for small files: OpenEXR takes some 450 bytes for the header of a part, and has
// no 8-bit channels.

/// Maximum number of bytes of a text that remains an attribute, which other programs can read. Longer ones are packed.
constexpr size_t kLongestOpenText = 256;

/// A zlib stream of the size in bytes of a JSON object that lists texts and tensors (32 bits, little-endian), that
/// object, and the tensors' values: residuals of bytes; for halves and floats, all highest bytes, then all
/// next lower ones, and so on. Tensors must pass check_tensor(). Throws Error(invalid_argument) beyond 4 GiB.
std::vector<uint8_t> encode_pack(const TensorFile& file);

struct PackLimits {
  std::function<bool(const std::string& tensor)> takes = {};  // others are skipped; empty: all are read
  uint64_t max_bytes = UINT64_MAX;                            // of all tensors, in memory
};

/// Throws Error(bad_data) that begins with `where`, before it allocates more than the bytes can expand to or than the
/// limits allow.
TensorFile decode_pack(std::span<const uint8_t> bytes, const std::string& where, const PackLimits& limits = {});

// Predicts the bytes of a map from their neighbors and stores the residuals, which compress better.

/// Replaces each byte of `maps` [map][row][column] by its residual, modulo 256, from a prediction by its left and lower
/// neighbors: the median of these two and the plane through them and the neighbor between them [WSS00].
void maps_to_rests(std::span<uint8_t> maps, uint64_t rows, uint64_t columns);

void rests_to_maps(std::span<uint8_t> rests, uint64_t rows, uint64_t columns);

// Layout of tensors and packs in the parts of OpenEXR files.

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
