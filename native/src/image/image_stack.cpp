#include "image/image_stack.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "file/atomic_file.h"
#include "image/exr_errors.h"
#include "image/exr_output.h"
#include "image/exr_scan.h"
#include "job/error.h"

namespace velour {
namespace {

/// Before the pixels of a row: the number of the part, where there are several, the row, the bytes of the pixels.
uint64_t chunk_head(size_t parts) { return parts > 1 ? 12 : 8; }

constexpr uint64_t kMostHeaderBytes = uint64_t{1} << 14;

/// As OpenEXR stores them: in alphabetical order.
std::vector<std::string> stored_channels(const ImageStack& stack) {
  return stack.channels == 3 ? std::vector<std::string>{"B", "G", "R"} : std::vector<std::string>{"Y"};
}

uint64_t value_bytes(const ImageStack& stack) { return stack.value == StackValue::half ? 2 : 4; }

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

void flip_rows(uint64_t row_bytes, std::span<uint8_t> image) {
  uint8_t* low = image.data();
  uint8_t* high = low + image.size() - row_bytes;
  for (; low < high; low += row_bytes, high -= row_bytes) std::swap_ranges(low, low + row_bytes, high);
}

/// `rows`: the image at the top of those that are still to be written, in the file's order.
void write_image(Imf::OutputPart& part, const ImageStack& stack, uint64_t image, std::span<uint8_t> rows) {
  const auto type = stack.value == StackValue::half ? Imf::HALF : Imf::FLOAT;
  const size_t pixel_bytes = stack.channels * value_bytes(stack);
  const Imath::Box2i window({0, static_cast<int>(image * stack.height)},
                            {static_cast<int>(stack.width) - 1, static_cast<int>((image + 1) * stack.height) - 1});
  Imf::FrameBuffer buffer;
  const std::vector<std::string> names = stored_channels(stack);
  for (size_t c = 0; c < names.size(); ++c) {
    uint8_t* channel = rows.data() + (names.size() - 1 - c) * value_bytes(stack);  // in memory: R, G, B
    buffer.insert(names[c], Imf::Slice::Make(type, channel, window, pixel_bytes, stack.row_bytes()));
  }
  part.setFrameBuffer(buffer);
  part.writePixels(static_cast<int>(stack.height));
}

void write_stack(Imf::OutputPart part, const ImageStack& stack, std::span<const uint8_t> pixels,
                 const Progress& progress) {
  std::vector<uint8_t> image(stack.image_bytes());
  for (uint64_t i = 0; i < stack.images; ++i) {
    progress.check();
    std::memcpy(image.data(), pixels.data() + i * image.size(), image.size());
    flip_rows(stack.row_bytes(), image);
    write_image(part, stack, i, image);
  }
}

void check_sizes(const std::string& path, const ImageStack& stack, std::span<const uint8_t> pixels) {
  const bool sized = stack.width > 0 && stack.height > 0 && stack.images > 0 &&
                     (stack.channels == 1 || stack.channels == 3) && stack.row_bytes() < INT32_MAX &&
                     stack.height < INT32_MAX / 2 && stack.images < INT32_MAX / 2 / stack.height;
  if (sized && pixels.size() == stack.images * stack.image_bytes()) return;
  throw Error(Status::invalid_argument, path + ": part '" + stack.name + "' has " + std::to_string(pixels.size()) +
                                            " bytes, which are not those of its images.");
}

/// Channels lie behind one another in a row of the file, and beside one another in memory.
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

/// Whether `chunk` begins with the last numbers of `expected`, as many as its head has.
bool is_chunk(const uint8_t* chunk, uint64_t head, const std::array<int32_t, 3>& expected) {
  const uint64_t skipped = sizeof(expected) - head;
  return std::memcmp(chunk, reinterpret_cast<const uint8_t*>(expected.data()) + skipped, head) == 0;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(Status::bad_data, path + ": " + what);
}

bool agrees(const ExrPart& part, const ImageStack& stack) {
  return part.name == stack.name && part.channels == stored_channels(stack) && part.value_bytes == value_bytes(stack) &&
         !part.integers && part.width == stack.width && part.height == stack.height * stack.images && !part.compressed;
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
    ExrOutput stream(file, path);
    Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
    for (size_t i = 0; i < stacks.size(); ++i) {
      write_stack(Imf::OutputPart(out, static_cast<int>(i)), stacks[i], pixels[i], progress);
    }
  });
  file.commit();
}

ImageStackFile::ImageStackFile(const std::string& path, std::vector<ImageStack> stacks)
    : file_(path), stacks_(std::move(stacks)) {
  std::vector<uint8_t> head(std::min(kMostHeaderBytes, file_.size()));
  file_.read(0, head);
  check_headers(head);
}

void ImageStackFile::check_headers(std::span<const uint8_t> head) {
  const ExrHeaders headers = scan_exr_headers(head, file_.path());
  const bool same = std::equal(headers.parts.begin(), headers.parts.end(), stacks_.begin(), stacks_.end(), agrees);
  if (!same) refuse(file_.path(), "its parts are not the ones that the index asks for; it belongs to something else.");
  uint64_t end = headers.bytes;
  for (const ImageStack& stack : stacks_) end += 8 * stack.images * stack.height;
  for (const ImageStack& stack : stacks_) {
    begin_.push_back(end);
    end += stack.images * stack.height * (chunk_head(stacks_.size()) + stack.row_bytes());
  }
  if (end != file_.size()) {
    refuse(file_.path(), "holds " + std::to_string(file_.size()) + " bytes where its images take " +
                             std::to_string(end) + "; it is truncated or damaged.");
  }
  tables_ = headers.bytes;
}

void ImageStackFile::check_chunk_tables() const {
  constexpr uint64_t kPiece = 8192;
  uint64_t position = tables_;
  std::vector<uint64_t> table(kPiece);
  for (size_t s = 0; s < stacks_.size(); ++s) {
    const uint64_t rows = stacks_[s].images * stacks_[s].height;
    const uint64_t step = chunk_head(stacks_.size()) + stacks_[s].row_bytes();
    for (uint64_t row = 0; row < rows; row += table.size()) {
      table.resize(std::min(kPiece, rows - row));
      file_.read(position, {reinterpret_cast<uint8_t*>(table.data()), 8 * table.size()});
      for (uint64_t i = 0; i < table.size(); ++i) {
        if (table[i] == begin_[s] + (row + i) * step) continue;
        refuse(file_.path(), "the chunk table of part '" + stacks_[s].name + "' is not in order; the file is damaged.");
      }
      position += 8 * table.size();
    }
    table.resize(kPiece);
  }
}

/// The rows of one image as they lie in the file, the top one first.
void ImageStackFile::read_image(size_t index, uint64_t image, std::span<uint8_t> chunks,
                                std::span<uint8_t> pixels) const {
  const ImageStack& stack = stacks_[index];
  const uint64_t row_bytes = stack.row_bytes(), head = chunk_head(stacks_.size()), step = head + row_bytes;
  file_.read(begin_[index] + image * stack.height * step, chunks);
  for (uint64_t row = 0; row < stack.height; ++row) {
    const uint8_t* chunk = chunks.data() + row * step;
    const uint64_t y = image * stack.height + row;
    if (!is_chunk(chunk, head,
                  {static_cast<int32_t>(index), static_cast<int32_t>(y), static_cast<int32_t>(row_bytes)})) {
      refuse(file_.path(), "row " + std::to_string(y) + " of part '" + stack.name + "' is damaged.");
    }
    copy_row(stack, chunk + head, pixels.data() + (stack.height - 1 - row) * row_bytes);
  }
}

void ImageStackFile::read(size_t stack, uint64_t first, std::span<uint8_t> pixels) const {
  const ImageStack& of = stacks_[stack];
  const uint64_t bytes = of.image_bytes(), count = pixels.size() / bytes;
  if (first > of.images || count > of.images - first || count * bytes != pixels.size()) {
    throw Error(Status::invalid_argument, file_.path() + ": part '" + of.name + "' does not have those images.");
  }
  std::vector<uint8_t> chunks(of.height * (chunk_head(stacks_.size()) + of.row_bytes()));
  for (uint64_t i = 0; i < count; ++i) read_image(stack, first + i, chunks, pixels.subspan(i * bytes, bytes));
}

}  // namespace velour
