// Bytes in fewer bytes: streams of zlib [RFC1950], which end with a checksum.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>
#include <vector>

namespace velour {

/// No byte of a stream stands for more than this many.
constexpr uint64_t kMostInflated = 1032;

class Deflater {
 public:
  Deflater();
  ~Deflater();
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  /// What repeats itself, as texts do.
  void write(std::span<const uint8_t> bytes) { write(bytes, Z_DEFAULT_STRATEGY); }
  /// What does not, but for runs: its bytes differ in how often they are.
  void write_rests(std::span<const uint8_t> bytes) { write(bytes, Z_RLE); }
  /// The stream; nothing is written after it.
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
  /// `bytes` must outlive it; what follows the stream in them is not looked at.
  explicit Inflater(std::span<const uint8_t> bytes);
  ~Inflater();
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// False where there are not as many more.
  bool read(std::span<uint8_t> to);
  /// Whether that was all, and the checksum is right.
  bool finish();

 private:
  z_stream stream_{};
};

}  // namespace velour
