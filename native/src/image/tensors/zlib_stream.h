// Compression with zlib streams [RFC1950], which end with a checksum.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>
#include <vector>

namespace velour {

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

}  // namespace velour
