#include "image/formats/exr_scan.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/byte_reader.h"
#include "image/formats/exr_header_check.h"

namespace velour {
namespace {

constexpr int32_t kMagic = 20000630;
constexpr uint32_t kTiled = 0x200, kDeep = 0x800, kMultiPart = 0x1000;
constexpr size_t kMaxParts = 4096;
/// Maximum expansion of a byte by DEFLATE.
constexpr uint64_t kMaxDeflateRatio = 1032;
constexpr int32_t kIntegerPixels = 0, kHalfPixels = 1, kFloatPixels = 2;

/// Data of a part that only the scan needs.
struct PartLayout {
  bool has_window = false;
  uint8_t compression = 255;
  int64_t chunk_count_claimed = -1;
  std::string type = "scanlineimage";

  uint64_t lines_per_chunk() const { return compression == 3 ? 16 : 1; }
};

[[noreturn]] void fail(const ByteReader& in, const ExrPart& part, const std::string& what) {
  throw Error(Status::bad_data, in.name() + ": part '" + part.name + "': " + what);
}

/// Accepts only values of a fixed size, strings and channel lists: OpenEXR's readers of other types take counts from
/// the values.
void check_type(const ByteReader& in, const ExrPart& part, const std::string& field, const std::string& type,
                int32_t size) {
  if (size < 0) fail(in, part, "attribute " + field + " has size " + std::to_string(size) + "; the file is damaged.");
  if (type == "string" || (type == "chlist" && field == "channels")) return;
  const auto fixed = fixed_exr_bytes(type);
  if (!fixed) {
    throw Error(Status::unsupported, in.name() + ": part '" + part.name + "': attribute " + field + " has type '" +
                                         type + "', which does not occur in files written by Velour.");
  }
  if (static_cast<uint32_t>(size) != *fixed) {
    fail(in, part,
         "attribute " + field + " of type " + type + " has size " + std::to_string(size) + ", not " +
             std::to_string(*fixed) + "; the file is damaged.");
  }
}

void read_channels(ByteReader value, ExrPart& part) {
  while (true) {
    const std::string channel = value.text(255, "channel name");
    if (channel.empty()) break;
    const auto pixel_type = value.number<int32_t>("channel type");
    value.take(4, "channel flags");
    const auto x_step = value.number<int32_t>("channel sampling");
    const auto y_step = value.number<int32_t>("channel sampling");
    if (pixel_type < kIntegerPixels || pixel_type > kFloatPixels || x_step != 1 || y_step != 1)
      fail(value, part,
           "channel " + channel + " is not a 32-bit or 16-bit float channel at full resolution; write floats.");
    if (part.channels.size() == 16) fail(value, part, "has more than 16 channels, which is not supported.");
    const uint64_t bytes = pixel_type == kHalfPixels ? 2 : 4;
    const bool integers = pixel_type == kIntegerPixels;
    if (!part.channels.empty() && (bytes != part.value_bytes || integers != part.integers))
      fail(value, part,
           "channel " + channel +
               " has a different type than the channels before it; write all channels with the same type.");
    part.value_bytes = bytes;
    part.integers = integers;
    part.channels.push_back(channel);
  }
  // OpenEXR would read the rest as the next attribute.
  if (value.remaining() != 0)
    fail(value, part, "attribute channels is longer than its channel list; the file is damaged.");
}

void read_window(ByteReader value, ExrPart& part, PartLayout& layout) {
  std::array<int32_t, 4> box;  // min x, min y, max x, max y
  for (int32_t& edge : box) edge = value.number<int32_t>("dataWindow");
  if (box[0] != 0 || box[1] != 0 || box[2] < 0 || box[3] < 0)
    fail(value, part,
         "dataWindow is (" + std::to_string(box[0]) + " " + std::to_string(box[1]) + ") to (" + std::to_string(box[2]) +
             " " + std::to_string(box[3]) + "); it must begin at (0 0).");
  part.width = static_cast<uint64_t>(box[2]) + 1;
  part.height = static_cast<uint64_t>(box[3]) + 1;
  layout.has_window = true;
}

std::string as_text(std::span<const uint8_t> value) { return {value.begin(), value.end()}; }

void read_attribute(ByteReader& in, const std::string& field, ExrPart& part, PartLayout& layout) {
  const std::string type = in.text(255, "type of attribute " + field);
  const auto size = in.number<int32_t>("size of attribute " + field);
  check_type(in, part, field, type, size);
  const auto value = in.take(static_cast<uint64_t>(size), "attribute " + field);
  const ByteReader sub(value, in.name());
  if (field == "channels" && type == "chlist")
    read_channels(sub, part);
  else if (field == "dataWindow" && type == "box2i")
    read_window(sub, part, layout);
  else if (field == "compression" && type == "compression")
    layout.compression = value[0];
  else if (field == "chunkCount" && type == "int")
    layout.chunk_count_claimed = ByteReader(sub).number<int32_t>(field);
  else if (field == "name" && type == "string")
    part.name = as_text(value);
  else if (field == "type" && type == "string")
    layout.type = as_text(value);
  else if (field == "velour.shape" && type == "string")
    part.shape = as_text(value);
  else if (field == "velour.coding" && type == "string")
    part.coding = as_text(value);
}

void check_part(const ByteReader& in, const ExrPart& part, const PartLayout& layout) {
  if (!layout.has_window) fail(in, part, "attribute dataWindow is missing.");
  if (part.channels.empty()) fail(in, part, "attribute channels is missing or empty.");
  if (layout.type != "scanlineimage") fail(in, part, "type is '" + layout.type + "'; it must be scanlineimage.");
  if (layout.compression != 0 && layout.compression != 2 && layout.compression != 3)
    fail(in, part, "compression is " + std::to_string(layout.compression) + "; only none, zips and zip are supported.");
  if (part.row_bytes() * layout.lines_per_chunk() > INT32_MAX)
    fail(in, part, "dataWindow has " + std::to_string(part.width) + " columns, more than fit into a chunk.");
}

/// Checks that each chunk lies in the file and is large enough for its pixels, and that all chunks together are no
/// larger than the file: otherwise, table entries could share a chunk and claim its pixels many times over. `left`:
/// bytes that previous chunks have not used.
void check_chunks(ByteReader& in, const ExrPart& part, const PartLayout& layout, bool multi_part, uint64_t& left) {
  const uint64_t lines = layout.lines_per_chunk();
  const uint64_t chunk_count = (part.height + lines - 1) / lines;
  if (layout.chunk_count_claimed >= 0 && static_cast<uint64_t>(layout.chunk_count_claimed) != chunk_count)
    fail(in, part,
         "chunkCount is " + std::to_string(layout.chunk_count_claimed) + ", but the dataWindow requires " +
             std::to_string(chunk_count) + ".");
  if (chunk_count > in.remaining() / 8)
    fail(in, part,
         "dataWindow has " + std::to_string(part.height) +
             " rows, more than the file can contain; it is truncated or damaged.");
  ByteReader chunk = in;
  for (uint64_t i = 0; i < chunk_count; ++i) {
    chunk.seek(in.number<uint64_t>("chunk table of part '" + part.name + "'"),
               "chunk table of part '" + part.name + "'");
    if (multi_part) chunk.take(4, "part number of a chunk");
    chunk.take(4, "first row of a chunk");
    const auto stored = chunk.number<uint32_t>("size of a chunk");
    chunk.take(stored, "chunk " + std::to_string(i) + " of part '" + part.name + "'");
    if (stored > left)
      fail(in, part, "its chunks and the chunks of earlier parts are larger than the file; the file is damaged.");
    left -= stored;
    const uint64_t rows = std::min(lines, part.height - i * lines);
    if (rows * part.row_bytes() > uint64_t{stored} * kMaxDeflateRatio)
      fail(in, part,
           "chunk " + std::to_string(i) + " holds " + std::to_string(stored) +
               " bytes, too few for its pixels; the file is damaged.");
  }
}

bool read_version(ByteReader& in) {
  if (in.number<int32_t>("magic number") != kMagic)
    throw Error(Status::bad_data, in.name() + ": is not an OpenEXR file.");
  const auto version = in.number<uint32_t>("version");
  if ((version & 0xff) != 2 || (version & (kTiled | kDeep)) != 0)
    throw Error(Status::unsupported, in.name() + ": OpenEXR version field is " + std::to_string(version) +
                                         "; only flat scan line files of version 2 are supported.");
  return (version & kMultiPart) != 0;
}

struct ScannedHeaders {
  bool multi_part = false;
  std::vector<ExrPart> parts;
  std::vector<PartLayout> layouts;
};

ScannedHeaders read_headers(ByteReader& in) {
  ScannedHeaders scanned{read_version(in), {}, {}};
  while (true) {
    std::string field = in.text(255, "attribute name");
    if (field.empty()) break;  // an empty header ends the list of a multi-part file
    if (scanned.parts.size() == kMaxParts)
      throw Error(Status::bad_data, in.name() + ": has more than 4096 parts, which is not supported.");
    ExrPart& part = scanned.parts.emplace_back();
    PartLayout& layout = scanned.layouts.emplace_back();
    for (; !field.empty(); field = in.text(255, "attribute name")) read_attribute(in, field, part, layout);
    check_part(in, part, layout);
    part.compressed = layout.compression != 0;
    if (!scanned.multi_part) break;
  }
  return scanned;
}

}  // namespace

std::vector<ExrPart> scan_exr(std::span<const uint8_t> bytes, const std::string& name) {
  ByteReader in(bytes, name);
  ScannedHeaders scanned = read_headers(in);
  uint64_t left = bytes.size();
  for (size_t i = 0; i < scanned.parts.size(); ++i) {
    check_chunks(in, scanned.parts[i], scanned.layouts[i], scanned.multi_part, left);
  }
  return std::move(scanned.parts);
}

ExrHeaders scan_exr_headers(std::span<const uint8_t> head, const std::string& name) {
  ByteReader in(head, name);
  ScannedHeaders scanned = read_headers(in);
  return {std::move(scanned.parts), in.position()};
}

}  // namespace velour
