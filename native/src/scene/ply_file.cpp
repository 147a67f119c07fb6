#include "scene/mesh_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/text_number.h"

namespace velour {
namespace {

enum class Format { ascii, little_endian, big_endian };
enum class Number { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  std::string name;
  Number type = Number::float32;
  std::optional<Number> count;  // type of a list's length; empty: a single number
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

size_t bytes_of(Number type) {
  constexpr std::array<size_t, 8> kBytes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<size_t>(type)];
}

std::optional<Number> number_named(const std::string& name) {
  constexpr std::array<std::array<const char*, 2>, 8> kNames = {{{"char", "int8"},
                                                                 {"uchar", "uint8"},
                                                                 {"short", "int16"},
                                                                 {"ushort", "uint16"},
                                                                 {"int", "int32"},
                                                                 {"uint", "uint32"},
                                                                 {"float", "float32"},
                                                                 {"double", "float64"}}};
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Number>(i);
  }
  return std::nullopt;
}

/// Reads the file's header lines and numbers sequentially.
class Reader {
 public:
  Reader(std::span<const uint8_t> bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  Format format = Format::ascii;

  [[noreturn]] void refuse(const std::string& why) const { throw Error(Status::bad_data, path_ + ": " + why); }

  /// Reads a line of the header, without its end: "\n", "\r\n" or "\r", as in the first line.
  std::string line() {
    const auto rest = bytes_.subspan(at_);
    const auto longest = rest.first(std::min<size_t>(kMaxLine, rest.size()));
    if (at_ == 0) find_line_end(longest);
    const auto end = std::find(longest.begin(), longest.end(), line_end_);
    if (end == longest.end()) refuse("the PLY header has no end; the file is truncated or damaged.");
    std::string text(longest.begin(), end);
    at_ += text.size() + 1;
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return text;
  }

  double number(Number type) { return format == Format::ascii ? ascii_number() : binary_number(type); }

  /// Minimum number of bytes of a number; of text, a digit and a blank.
  uint64_t least_bytes(Number type) const { return format == Format::ascii ? 2 : bytes_of(type); }

  /// Throws unless the rest of the file can hold `count` items of at least `bytes` bytes each.
  void expect(uint64_t count, uint64_t bytes, const std::string& what) const {
    if (count > (bytes_.size() - at_) / std::max<uint64_t>(1, bytes)) {
      refuse("the file claims to contain " + std::to_string(count) + " " + what +
             ", but it is too short; it is truncated or damaged.");
    }
  }

 private:
  static constexpr size_t kMaxLine = 4096;

  /// In a file with "\r" line ends, a "\n" after the header is not part of a line end but may begin a binary number.
  void find_line_end(std::span<const uint8_t> head) {
    const auto found = std::ranges::find_if(head, [](uint8_t c) { return c == '\n' || c == '\r'; });
    const bool lone = found != head.end() && *found == '\r' && (found + 1 == head.end() || found[1] != '\n');
    line_end_ = lone ? '\r' : '\n';
  }

  static bool is_space(uint8_t c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

  double ascii_number() {
    while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
    const std::string_view rest =
        std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size()).substr(at_);
    if (rest.empty()) refuse("the file ends before its last number; it is truncated.");
    const auto number = leading_number(rest);
    if (!number || (number->length < rest.size() && !is_space(static_cast<uint8_t>(rest[number->length])))) {
      refuse("there is no number at byte " + std::to_string(at_) + "; the file is damaged.");
    }
    const std::string_view text = rest.substr(0, number->length);
    if (std::isinf(number->value) && text.find_first_of("123456789") != std::string_view::npos) {
      refuse("the number '" + std::string(text.substr(0, 40)) + "' at byte " + std::to_string(at_) +
             " is too large; use smaller units.");
    }
    at_ += number->length;
    return number->value;
  }

  template <typename T>
  double read_as() {
    std::array<uint8_t, sizeof(T)> raw;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), sizeof(T), raw.begin());
    if (format == Format::big_endian) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<T>(raw));
  }

  double binary_number(Number type) {
    if (bytes_.size() - at_ < bytes_of(type)) refuse("the file ends before its last number; it is truncated.");
    const double value = decoded(type);
    at_ += bytes_of(type);
    return value;
  }

  double decoded(Number type) {
    switch (type) {
      case Number::int8:
        return read_as<int8_t>();
      case Number::uint8:
        return read_as<uint8_t>();
      case Number::int16:
        return read_as<int16_t>();
      case Number::uint16:
        return read_as<uint16_t>();
      case Number::int32:
        return read_as<int32_t>();
      case Number::uint32:
        return read_as<uint32_t>();
      case Number::float32:
        return read_as<float>();
      case Number::float64:
        break;
    }
    return read_as<double>();
  }

  std::span<const uint8_t> bytes_;
  const std::string& path_;
  size_t at_ = 0;
  uint8_t line_end_ = '\n';
};

Property read_property(std::istringstream& words, const Reader& reader) {
  const auto type = [&] {
    std::string name;
    words >> name;
    const auto number = number_named(name);
    if (!number) reader.refuse("'" + name + "' is not a valid PLY property type.");
    return *number;
  };
  Property property;
  const auto start = words.tellg();
  std::string first;
  words >> first;
  if (first == "list") {
    property.count = type();
  } else {
    words.seekg(start);
  }
  property.type = type();
  words >> property.name;
  return property;
}

std::vector<Element> read_header(Reader& reader) {
  if (reader.line() != "ply") reader.refuse("is not a PLY file. If it is an OBJ file, rename it.");
  std::vector<Element> elements;
  std::set<std::string> names;
  for (;;) {
    std::istringstream words(reader.line());
    std::string word, value;
    words >> word;
    if (word == "end_header") return elements;
    if (word == "format") {
      words >> value;
      if (value != "ascii" && value != "binary_little_endian" && value != "binary_big_endian") {
        reader.refuse("its format is '" + value + "'; it must be ascii, binary_little_endian or binary_big_endian.");
      }
      reader.format = value == "ascii"                  ? Format::ascii
                      : value == "binary_little_endian" ? Format::little_endian
                                                        : Format::big_endian;
    } else if (word == "element") {
      Element element;
      if (!(words >> element.name >> element.count)) reader.refuse("an element in its header has no name or no count.");
      // If a second vertex list lacked normals, its corners would index past the end of the first list's normals.
      if (!names.insert(element.name).second) {
        reader.refuse("its header has two elements named '" + element.name + "'; merge them.");
      }
      elements.push_back(std::move(element));
    } else if (word == "property") {
      if (elements.empty()) reader.refuse("its header has a property before any element.");
      elements.back().properties.push_back(read_property(words, reader));
    }
  }
}

struct Content {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;          // of vertices
  std::vector<uint32_t> corners;  // vertices of the faces, one after the other; checked at the end
  std::vector<uint32_t> face_sizes;
  std::vector<Vec2> corner_uvs;  // "texcoord", as written by MeshLab: for all corners or none
};

/// Minimum number of bytes of one entry of `element`.
uint64_t least_bytes(const Element& element, const Reader& reader) {
  uint64_t bytes = 0;
  for (const Property& p : element.properties) bytes += reader.least_bytes(p.count ? *p.count : p.type);
  return bytes;
}

/// Index of a vertex property in x, y, z, nx, ny, nz, s, t; empty for others.
std::optional<size_t> place_of(const std::string& name) {
  constexpr std::array<const char*, 8> kNames = {"x", "y", "z", "nx", "ny", "nz", "s", "t"};
  const std::string same = name == "u" || name == "texture_u" ? "s" : name == "v" || name == "texture_v" ? "t" : name;
  const auto* found = std::find(kNames.begin(), kNames.end(), same);
  return found == kNames.end() ? std::nullopt : std::optional(static_cast<size_t>(found - kNames.begin()));
}

uint64_t read_count(Reader& reader, const Property& property) {
  const double count = reader.number(*property.count);
  if (!(count >= 0) || count > 1e9) reader.refuse("a list has an invalid length; the file is damaged.");
  return static_cast<uint64_t>(count);
}

void skip(Reader& reader, const Property& property) {
  const uint64_t count = property.count ? read_count(reader, property) : 1;
  for (uint64_t i = 0; i < count; ++i) reader.number(property.type);
}

void read_vertices(Reader& reader, const Element& element, Content& content) {
  std::array<bool, 8> there{};
  for (const Property& p : element.properties) {
    if (const auto place = place_of(p.name); place && !p.count) there[*place] = true;
  }
  if (!there[0] || !there[1] || !there[2]) reader.refuse("its vertices do not have the properties x, y and z.");
  for (uint64_t i = 0; i < element.count; ++i) {
    std::array<float, 8> values{};
    for (const Property& p : element.properties) {
      const auto place = p.count ? std::nullopt : place_of(p.name);
      if (place) {
        values[*place] = static_cast<float>(reader.number(p.type));
      } else {
        skip(reader, p);
      }
    }
    content.positions.push_back({values[0], values[1], values[2]});
    if (there[3] && there[4] && there[5]) content.normals.push_back({values[3], values[4], values[5]});
    if (there[6] && there[7]) content.uvs.push_back({values[6], values[7]});
  }
}

uint32_t vertex_index(const Reader& reader, double number) {
  if (!(number >= 0) || number > UINT32_MAX) reader.refuse("a face has an invalid vertex index.");
  return static_cast<uint32_t>(number);
}

void read_polygon(Reader& reader, const Property& property, Content& content) {
  const uint64_t count = read_count(reader, property);
  reader.expect(count, reader.least_bytes(property.type), "corners of a face");
  if (count > PolygonTriangles::kMaxCorners) {
    reader.refuse("a face has " + std::to_string(count) + " corners, more than " +
                  std::to_string(PolygonTriangles::kMaxCorners) + ". Split it into smaller faces.");
  }
  for (uint64_t i = 0; i < count; ++i) content.corners.push_back(vertex_index(reader, reader.number(property.type)));
  content.face_sizes.push_back(static_cast<uint32_t>(count));
}

/// Triangles of three consecutive vertices each, of which every second is flipped. The index -1 begins a new strip;
/// triangles that name a vertex twice connect strips.
void read_strip(Reader& reader, const Property& property, Content& content) {
  const uint64_t count = read_count(reader, property);
  reader.expect(count, reader.least_bytes(property.type), "vertices of a triangle strip");
  std::array<uint32_t, 3> last{};
  uint64_t length = 0;  // of the current strip
  for (uint64_t i = 0; i < count; ++i) {
    const double vertex = reader.number(property.type);
    if (vertex == -1) {
      length = 0;
      continue;
    }
    last = {last[1], last[2], vertex_index(reader, vertex)};
    if (++length < 3 || last[0] == last[1] || last[1] == last[2] || last[2] == last[0]) continue;
    const bool flipped = length % 2 == 0;
    content.corners.insert(content.corners.end(), {last[0], last[flipped ? 2 : 1], last[flipped ? 1 : 2]});
    content.face_sizes.push_back(3);
  }
}

/// Reads two numbers per corner of the face. `uvs` is later resized to the face's number of corners.
void read_corner_uvs(Reader& reader, const Property& property, std::vector<Vec2>& uvs) {
  const uint64_t count = read_count(reader, property);
  reader.expect(count, reader.least_bytes(property.type), "texture coordinates of a face");
  uvs.clear();
  for (uint64_t i = 0; i + 1 < count; i += 2) {
    const auto u = static_cast<float>(reader.number(property.type));
    uvs.push_back({u, static_cast<float>(reader.number(property.type))});
  }
  if (count % 2 == 1) reader.number(property.type);
}

bool lists_vertices(const Property& p) { return p.count && (p.name == "vertex_indices" || p.name == "vertex_index"); }

void read_strips(Reader& reader, const Element& element, Content& content) {
  for (uint64_t i = 0; i < element.count; ++i) {
    for (const Property& p : element.properties) {
      if (lists_vertices(p)) {
        read_strip(reader, p, content);
      } else {
        skip(reader, p);
      }
    }
  }
}

void read_faces(Reader& reader, const Element& element, Content& content) {
  const bool has_uvs =
      std::ranges::any_of(element.properties, [](const Property& p) { return p.count && p.name == "texcoord"; });
  std::vector<Vec2> uvs;
  if (has_uvs) content.corner_uvs.resize(content.corners.size(), Vec2(0.0f));  // of strips
  for (uint64_t i = 0; i < element.count; ++i) {
    const size_t first = content.corners.size();
    for (const Property& p : element.properties) {
      if (lists_vertices(p)) {
        read_polygon(reader, p, content);
      } else if (p.count && p.name == "texcoord") {
        read_corner_uvs(reader, p, uvs);
      } else {
        skip(reader, p);
      }
    }
    if (!has_uvs) continue;
    uvs.resize(content.corners.size() - first, Vec2(0.0f));
    content.corner_uvs.insert(content.corner_uvs.end(), uvs.begin(), uvs.end());
  }
}

/// Cuts the faces into triangles of corner indices.
std::vector<glm::uvec3> cut_faces(const Content& content) {
  PolygonTriangles cutter;
  std::vector<glm::uvec3> triangles;
  std::vector<Vec3> polygon;
  uint32_t first = 0;
  for (const uint32_t count : content.face_sizes) {
    if (count >= 3) {
      polygon.clear();
      for (uint32_t i = 0; i < count; ++i) polygon.push_back(content.positions[content.corners[first + i]]);
      for (const glm::uvec3& triangle : cutter.cut(polygon)) triangles.push_back(triangle + glm::uvec3(first));
    }
    first += count;
  }
  return triangles;
}

template <typename T>
std::vector<T> at_corners(const std::vector<T>& of_vertices, const std::vector<uint32_t>& vertices) {
  std::vector<T> corners;
  if (of_vertices.empty()) return corners;
  corners.reserve(vertices.size());
  for (const uint32_t vertex : vertices) corners.push_back(of_vertices[vertex]);
  return corners;
}

}  // namespace

Mesh read_ply(const std::string& path) {
  const std::vector<uint8_t> bytes = read_file(path);
  Reader reader(bytes, path);
  const std::vector<Element> elements = read_header(reader);
  Content content;
  for (const Element& element : elements) {
    reader.expect(element.count, least_bytes(element, reader), "'" + element.name + "' elements");
    if (element.name == "vertex") {
      read_vertices(reader, element, content);
    } else if (element.name == "face") {
      read_faces(reader, element, content);
    } else if (element.name == "tristrips") {
      read_strips(reader, element, content);
    } else if (!element.properties.empty()) {
      for (uint64_t i = 0; i < element.count; ++i) {
        for (const Property& p : element.properties) skip(reader, p);
      }
    }
  }
  if (!content.corner_uvs.empty()) content.corner_uvs.resize(content.corners.size(), Vec2(0.0f));
  const size_t vertices = content.positions.size();
  for (const uint32_t vertex : content.corners) {
    if (vertex >= vertices) {
      reader.refuse("a face has vertex index " + std::to_string(vertex) + " (from 0), but the file has only " +
                    std::to_string(vertices) + " vertices.");
    }
  }
  const std::vector<glm::uvec3> triangles = cut_faces(content);
  if (triangles.empty()) reader.refuse("contains no faces.");
  const std::vector<Vec3> normals = at_corners(content.normals, content.corners);
  const std::vector<Vec2> uvs = at_corners(content.uvs, content.corners);
  return Mesh({.positions = content.positions,
               .triangles = triangles,
               .corner_normals = normals,
               .corner_uvs = content.corner_uvs.empty() ? uvs : content.corner_uvs,
               .corner_vertices = content.corners});
}

}  // namespace velour
