#include "image/tensors/zlib_stream.h"

#include <new>

#include "base/error.h"

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

}  // namespace velour
