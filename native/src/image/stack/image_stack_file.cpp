#include "image/stack/image_stack_file.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "image/formats/exr_scan.h"

namespace velour {
namespace {

constexpr uint64_t kMaxHeaderBytes = uint64_t{1} << 14;

/// Converts a row from planes, as in the file, to interleaved channels, as in memory.
template <typename Value>
void interleave(const uint8_t* planes, uint64_t width, uint8_t* row) {
  const auto* from = reinterpret_cast<const Value*>(planes);
  auto* to = reinterpret_cast<Value*>(row);
  for (uint64_t x = 0; x < width; ++x) {
    to[3 * x] = from[2 * width + x];
    to[3 * x + 1] = from[width + x];
    to[3 * x + 2] = from[x];
  }
}

void copy_row(const ImageStack& stack, const uint8_t* planes, uint8_t* row) {
  if (stack.channels == 1) {
    std::memcpy(row, planes, stack.row_bytes());
  } else if (stack.value == StackValue::half) {
    interleave<uint16_t>(planes, stack.width, row);
  } else {
    interleave<uint32_t>(planes, stack.width, row);
  }
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(Status::bad_data, path + ": " + what);
}

bool agrees(const ExrPart& part, const ImageStack& stack) {
  return part.name == stack.name && part.channels == stored_channels(stack) &&
         part.value_bytes == stack.value_bytes() && !part.integers && part.width == stack.width &&
         part.height == stack.height * stack.images && !part.compressed;
}

}  // namespace

ImageStackFile::ImageStackFile(const std::string& path, std::vector<ImageStack> stacks)
    : file_(path), stacks_(std::move(stacks)) {
  std::vector<uint8_t> head(std::min(kMaxHeaderBytes, file_.size()));
  file_.read(0, head);
  check_headers(head);
}

void ImageStackFile::check_headers(std::span<const uint8_t> head) {
  const ExrHeaders headers = scan_exr_headers(head, file_.path());
  const bool same = std::equal(headers.parts.begin(), headers.parts.end(), stacks_.begin(), stacks_.end(), agrees);
  if (!same)
    refuse(file_.path(),
           "its parts do not match the index of the BTF (btf.json); the file belongs to another BTF. Copy the whole "
           "folder again.");
  layout_ = StackLayout(stacks_, headers.bytes);
  if (layout_.bytes() != file_.size()) {
    refuse(file_.path(), "has " + std::to_string(file_.size()) + " bytes, but its images require " +
                             std::to_string(layout_.bytes()) + "; it is truncated or damaged.");
  }
}

void ImageStackFile::check_chunk_tables() const {
  constexpr uint64_t kPiece = 8192;
  uint64_t position = layout_.tables();
  std::vector<uint64_t> table(kPiece);
  for (size_t s = 0; s < stacks_.size(); ++s) {
    const uint64_t rows = stacks_[s].images * stacks_[s].height;
    for (uint64_t row = 0; row < rows; row += table.size()) {
      table.resize(std::min(kPiece, rows - row));
      file_.read(position, {reinterpret_cast<uint8_t*>(table.data()), 8 * table.size()});
      for (uint64_t i = 0; i < table.size(); ++i) {
        if (table[i] == layout_.chunk(s, row + i)) continue;
        refuse(file_.path(), "the chunk table of part '" + stacks_[s].name + "' is not in order; the file is damaged.");
      }
      position += 8 * table.size();
    }
    table.resize(kPiece);
  }
}

/// Reads one image, whose rows are stored from top to bottom. `chunks`: scratch memory for its chunks.
void ImageStackFile::read_image(size_t index, uint64_t image, std::span<uint8_t> chunks,
                                std::span<uint8_t> pixels) const {
  const ImageStack& stack = stacks_[index];
  const uint64_t row_bytes = stack.row_bytes(), top = image * stack.height;
  file_.read(layout_.chunk(index, top), chunks);
  for (uint64_t row = 0; row < stack.height; ++row) {
    const uint8_t* chunk = chunks.data() + row * layout_.step(index);
    if (!layout_.has_head(index, top + row, chunk)) {
      refuse(file_.path(),
             "row " + std::to_string(top + row) + " of part '" + stack.name + "' is damaged. Copy the file again.");
    }
    copy_row(stack, chunk + layout_.head_bytes(), pixels.data() + (stack.height - 1 - row) * row_bytes);
  }
}

void ImageStackFile::read(size_t stack, uint64_t first, std::span<uint8_t> pixels) const {
  const ImageStack& of = stacks_[stack];
  const uint64_t bytes = of.image_bytes(), count = pixels.size() / bytes;
  if (first > of.images || count > of.images - first || count * bytes != pixels.size()) {
    throw Error(Status::invalid_argument,
                file_.path() + ": part '" + of.name + "' does not have the requested images.");
  }
  std::vector<uint8_t> chunks(of.height * layout_.step(stack));
  for (uint64_t i = 0; i < count; ++i) read_image(stack, first + i, chunks, pixels.subspan(i * bytes, bytes));
}

}  // namespace velour
