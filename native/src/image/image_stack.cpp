#include "image/image_stack.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "image/formats/exr_header_check.h"
#include "image/formats/exr_picture.h"
#include "image/formats/exr_scan.h"

namespace velour {

namespace {

Imf::Header header_of(const ImageStack& stack, const Imath::Box2i& display) {
  const Imath::Box2i window({0, 0},
                            {static_cast<int>(stack.width) - 1, static_cast<int>(stack.height * stack.images) - 1});
  Imf::Header header(display.isEmpty() ? window : display, window);
  header.setName(stack.name);
  header.setType(Imf::SCANLINEIMAGE);
  header.compression() = Imf::NO_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709
  for (const std::string& channel : stored_channels(stack)) {
    header.channels().insert(channel, Imf::Channel(stack.value == StackValue::half ? Imf::HALF : Imf::FLOAT));
  }
  return header;
}

std::vector<Imf::Header> headers_of(std::span<const ImageStack> stacks) {
  std::vector<Imf::Header> headers;
  for (const ImageStack& stack : stacks) {
    headers.push_back(header_of(stack, headers.empty() ? Imath::Box2i() : headers[0].displayWindow()));
  }
  return headers;
}

/// Converts a row from interleaved channels, as in memory, to planes, as in the file.
template <typename Value>
void separate(const uint8_t* row, uint64_t width, uint8_t* planes) {
  const auto* from = reinterpret_cast<const Value*>(row);
  auto* to = reinterpret_cast<Value*>(planes);
  for (uint64_t x = 0; x < width; ++x) {
    to[x] = from[3 * x + 2];
    to[width + x] = from[3 * x + 1];
    to[2 * width + x] = from[3 * x];
  }
}

void store_row(const ImageStack& stack, const uint8_t* row, uint8_t* planes) {
  if (stack.channels == 1) {
    std::memcpy(planes, row, stack.row_bytes());
  } else if (stack.value == StackValue::half) {
    separate<uint16_t>(row, stack.width, planes);
  } else {
    separate<uint32_t>(row, stack.width, planes);
  }
}

/// Writes the headers and returns their size. OpenEXR also leaves room for the chunk tables, which is subtracted.
uint64_t write_headers(AtomicFile& file, const std::string& path, std::span<const Imf::Header> headers,
                       std::span<const ImageStack> stacks) {
  ExrOutput stream(file, path);
  const Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
  return stream.tellp() - StackLayout(stacks, 0).chunk(0, 0);
}

void write_tables(AtomicFile& file, const StackLayout& layout, std::span<const ImageStack> stacks) {
  file.seek(layout.tables());
  std::vector<uint64_t> table;
  for (size_t i = 0; i < stacks.size(); ++i) {
    table.resize(stacks[i].images * stacks[i].height);
    for (size_t y = 0; y < table.size(); ++y) table[y] = layout.chunk(i, y);
    file.write({reinterpret_cast<const uint8_t*>(table.data()), 8 * table.size()});
  }
}

/// Writes the chunks directly: OpenEXR hands each row to threads that Blender has started, which took two thirds of the
/// time of a capture of small texels.
void write_stack(AtomicFile& file, const StackLayout& layout, const ImageStack& stack, size_t index,
                 std::span<const uint8_t> pixels, const Progress& progress) {
  const uint64_t row_bytes = stack.row_bytes();
  std::vector<uint8_t> chunks(stack.height * layout.step(index));
  for (uint64_t i = 0; i < stack.images; ++i) {
    progress.check();
    const uint8_t* image = pixels.data() + i * stack.image_bytes();
    for (uint64_t row = 0; row < stack.height; ++row) {
      uint8_t* chunk = chunks.data() + row * layout.step(index);
      layout.write_head(index, i * stack.height + row, chunk);
      store_row(stack, image + (stack.height - 1 - row) * row_bytes, chunk + layout.head_bytes());
    }
    file.write(chunks);
  }
}

void check_sizes(const std::string& path, const ImageStack& stack, std::span<const uint8_t> pixels) {
  const bool sized = stack.width > 0 && stack.height > 0 && stack.images > 0 &&
                     (stack.channels == 1 || stack.channels == 3) && stack.row_bytes() < INT32_MAX &&
                     stack.height < INT32_MAX / 2 && stack.images < INT32_MAX / 2 / stack.height;
  if (sized && pixels.size() == stack.images * stack.image_bytes()) return;
  throw Error(Status::invalid_argument, path + ": part '" + stack.name + "' has " + std::to_string(pixels.size()) +
                                            " bytes, which does not match the size of its images.");
}

}  // namespace

void write_image_stacks(const std::string& path, std::span<const ImageStack> stacks,
                        std::span<const std::span<const uint8_t>> pixels, const ImageAttributes& attributes,
                        const Progress& progress) {
  for (size_t i = 0; i < stacks.size(); ++i) check_sizes(path, stacks[i], pixels[i]);
  std::vector<Imf::Header> headers = headers_of(stacks);
  for (const auto& [name, text] : attributes) headers.at(0).insert(name, Imf::StringAttribute(text));
  AtomicFile file(path);
  const auto sentence = [&](const char* why) { return path + ": OpenEXR cannot write the images: " + why; };
  with_exr_errors(Status::io, sentence, [&] {
    const StackLayout layout(stacks, write_headers(file, path, headers, stacks));
    write_tables(file, layout, stacks);
    for (size_t i = 0; i < stacks.size(); ++i) write_stack(file, layout, stacks[i], i, pixels[i], progress);
  });
  file.commit();
}

std::vector<std::string> stored_channels(const ImageStack& stack) {
  return stack.channels == 3 ? std::vector<std::string>{"B", "G", "R"} : std::vector<std::string>{"Y"};
}

StackLayout::StackLayout(std::span<const ImageStack> stacks, uint64_t headers) : tables_(headers), bytes_(headers) {
  for (const ImageStack& stack : stacks) {
    row_bytes_.push_back(stack.row_bytes());
    bytes_ += 8 * stack.images * stack.height;
  }
  for (size_t i = 0; i < stacks.size(); ++i) {
    begin_.push_back(bytes_);
    bytes_ += stacks[i].images * stacks[i].height * step(i);
  }
}

std::array<uint8_t, 12> StackLayout::whole_head(size_t stack, uint64_t y) const {
  const std::array<int32_t, 3> numbers{static_cast<int32_t>(stack), static_cast<int32_t>(y),
                                       static_cast<int32_t>(row_bytes_[stack])};
  std::array<uint8_t, 12> bytes;
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

void StackLayout::write_head(size_t stack, uint64_t y, uint8_t* chunk) const {
  const auto head = whole_head(stack, y);
  std::memcpy(chunk, head.data() + head.size() - head_bytes(), head_bytes());
}

bool StackLayout::has_head(size_t stack, uint64_t y, const uint8_t* chunk) const {
  const auto head = whole_head(stack, y);
  return std::memcmp(chunk, head.data() + head.size() - head_bytes(), head_bytes()) == 0;
}

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

[[noreturn]] void refuse_stack(const std::string& path, const std::string& what) {
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
    refuse_stack(
        file_.path(),
        "its parts do not match the index of the BTF (btf.json); the file belongs to another BTF. Copy the whole "
        "folder again.");
  layout_ = StackLayout(stacks_, headers.bytes);
  if (layout_.bytes() != file_.size()) {
    refuse_stack(file_.path(), "has " + std::to_string(file_.size()) + " bytes, but its images require " +
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
        refuse_stack(file_.path(),
                     "the chunk table of part '" + stacks_[s].name + "' is not in order; the file is damaged.");
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
      refuse_stack(file_.path(), "row " + std::to_string(top + row) + " of part '" + stack.name +
                                     "' is damaged. Copy the file again.");
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
