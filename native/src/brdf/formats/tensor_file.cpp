#include "brdf/formats/tensor_file.h"

#include <algorithm>
#include <cstring>

#include "base/byte_reader.h"

namespace velour {
namespace {

constexpr char kMagic[12] = "tensor_file";  // with its zero byte
constexpr uint64_t kMinFieldBytes = 13;     // with an empty name and no dimensions
constexpr uint16_t kMaxRank = 16;

uint64_t type_size(uint8_t code) {
  constexpr uint8_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  return code < sizeof kSizes ? kSizes[code] : 0;
}

uint32_t read_header(ByteReader& in) {
  const auto magic = in.take(sizeof kMagic, "magic number");
  if (std::memcmp(magic.data(), kMagic, sizeof kMagic) != 0)
    throw Error(Status::bad_data, in.name() + ": is not a tensor file (RGL .bsdf).");
  const auto major = in.number<uint8_t>("version");
  in.number<uint8_t>("version");
  if (major != 1)
    throw Error(Status::unsupported,
                in.name() + ": tensor file version is " + std::to_string(major) + "; only version 1 is supported.");
  const auto count = in.number<uint32_t>("number of fields");
  if (count > in.remaining() / kMinFieldBytes)
    throw Error(Status::bad_data, in.name() + ": number of fields is " + std::to_string(count) +
                                      ", more than the file can hold; it is truncated or damaged.");
  return count;
}

}  // namespace

TensorContainer::TensorContainer(std::span<const uint8_t> bytes, std::string name)
    : name_(std::move(name)), file_(bytes) {
  ByteReader in(bytes, name_);
  const uint32_t count = read_header(in);
  for (uint32_t i = 0; i < count; ++i) read_entry(in);
  check_layout(in.position());
}

void TensorContainer::read_entry(ByteReader& in) {
  const auto letters = in.take(in.number<uint16_t>("length of a field name"), "field name");
  const std::string field(letters.begin(), letters.end());
  const auto rank = in.number<uint16_t>("rank of field " + field);
  const auto code = in.number<uint8_t>("type of field " + field);
  const auto offset = in.number<uint64_t>("offset of field " + field);
  if (type_size(code) == 0) fail(field, "has type " + std::to_string(code) + ", which is unknown.");
  if (rank > kMaxRank) fail(field, "has " + std::to_string(rank) + " dimensions; at most 16 are supported.");
  const auto [place, is_new] = fields_.try_emplace(field);
  if (!is_new) fail(field, "occurs more than once.");
  TensorField& entry = place->second;
  entry.type = static_cast<TensorType>(code);
  uint64_t size = type_size(code);
  for (uint16_t d = 0; d < rank; ++d) {
    const auto extent = entry.shape.emplace_back(in.number<uint64_t>("shape of field " + field));
    if (extent == 0 || size > file_.size() / extent)
      fail(field, "has an extent of " + std::to_string(extent) + " in dimension " + std::to_string(d) +
                      ", but the file has " + std::to_string(file_.size()) + " bytes; it is truncated or damaged.");
    size *= extent;
  }
  ByteReader values = in;
  values.seek(offset, "offset of field " + field);
  entry.bytes = values.take(size, "field " + field);
}

/// Rejects fields that overlap each other or the header, even if they could be read.
void TensorContainer::check_layout(uint64_t header_end) const {
  std::vector<std::pair<const uint8_t*, const std::string*>> order;
  for (const auto& [field, entry] : fields_) order.emplace_back(entry.bytes.data(), &field);
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const uint8_t* free_from = file_.data() + header_end;
  for (const auto& [begin, field] : order) {
    if (begin < free_from)
      fail(*field, "begins at byte " + std::to_string(begin - file_.data()) + ", inside the header or another field.");
    free_from = begin + fields_.at(*field).bytes.size();
  }
}

void TensorContainer::fail(const std::string& field, const std::string& what) const {
  throw Error(Status::bad_data, name_ + ": field " + field + " " + what);
}

const TensorField& TensorContainer::get(const std::string& field, TensorType type, size_t rank) const {
  const auto found = fields_.find(field);
  if (found == fields_.end()) fail(field, "is missing.");
  if (found->second.type != type)
    fail(field, "has type " + std::to_string(static_cast<int>(found->second.type)) + ", not " +
                    std::to_string(static_cast<int>(type)) + ".");
  if (found->second.shape.size() != rank)
    fail(field, "has " + std::to_string(found->second.shape.size()) + " dimensions, not " + std::to_string(rank) + ".");
  return found->second;
}

std::vector<float> TensorContainer::floats(const std::string& field, size_t rank) const {
  const auto& bytes = get(field, TensorType::float32, rank).bytes;
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::string TensorContainer::text(const std::string& field) const {
  const auto& bytes = get(field, TensorType::uint8, 1).bytes;
  return {bytes.begin(), bytes.end()};
}

bool looks_like_tensor_file(std::span<const uint8_t> head) {
  return head.size() >= sizeof kMagic && std::memcmp(head.data(), kMagic, sizeof kMagic) == 0;
}

}  // namespace velour
