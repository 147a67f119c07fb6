// tinyobjloader is not used: it does not name the line of an error, reads "1,5" as 1, does not support continued lines,
// and its triangulation depends on the position of the origin.
#include "scene/mesh_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include "base/error.h"
#include "base/file.h"
#include "base/text_number.h"

namespace velour {

namespace {

constexpr uint32_t kNone = UINT32_MAX;

/// A corner of a face: indices into the file's lists, from 0; kNone: not given.
struct ObjCorner {
  uint32_t position, uv, normal;
};

struct ObjContent {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<ObjCorner> corners;
  struct Face {
    uint32_t first, count;  // range of `corners`
    bool smooth;
  };
  std::vector<Face> faces;
  size_t too_small = 0;  // faces of fewer than three corners
};

/// Parses a file line by line, with continuation lines, comments and any kind of line end.
class ObjReader {
 public:
  ObjReader(std::span<const uint8_t> bytes, const std::string& path)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), path_(path) {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (text_.starts_with(kMark)) at_ = kMark.size();
  }

  ObjContent read() {
    while (at_ < text_.size()) {
      next_line();
      const std::string_view keyword = word();
      if (keyword == "v")
        content_.positions.push_back(vector("v"));
      else if (keyword == "vn")
        content_.normals.push_back(vector("vn"));
      else if (keyword == "vt")
        read_uv();
      else if (keyword == "f")
        read_face();
      else if (keyword == "s")
        read_smoothing();
      else if (keyword == "o" && !line_.empty())
        smooth_ = false;  // as in Blender's importer
    }
    check_indices();
    return std::move(content_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(Status::bad_data, path_ + ": line " + std::to_string(line_number_) + ": " + why);
  }

  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

  /// Skips a line end of one or two characters.
  void skip_line_end() {
    if (at_ < text_.size() && text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    if (at_ < text_.size()) ++at_;
    ++lines_read_;
  }

  /// Sets `line_` to the next line, joined with the following ones as long as lines end in a backslash.
  void next_line() {
    line_number_ = lines_read_ + 1;
    const size_t begin = at_;
    while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
    line_ = text_.substr(begin, at_ - begin);
    if (!continues(line_)) return end_line();
    joined_.assign(line_.substr(0, line_.size() - 1));
    bool goes_on = true;
    while (goes_on && at_ < text_.size()) {
      skip_line_end();
      const size_t more = at_;
      while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
      const std::string_view part = text_.substr(more, at_ - more);
      goes_on = continues(part);
      joined_ += ' ';
      joined_ += goes_on ? part.substr(0, part.size() - 1) : part;
    }
    line_ = joined_;
    end_line();
  }

  /// Lines with comments do not continue: a comment may end in the backslash of a folder's name.
  static bool continues(std::string_view line) {
    return line.ends_with('\\') && line.find('#') == std::string_view::npos;
  }

  void end_line() {
    skip_line_end();
    line_ = line_.substr(0, line_.find('#'));
  }

  /// Consumes and returns the next word of the line; empty at its end.
  std::string_view word() {
    size_t begin = 0;
    while (begin < line_.size() && is_space(line_[begin])) ++begin;
    size_t end = begin;
    while (end < line_.size() && !is_space(line_[end])) ++end;
    const std::string_view found = line_.substr(begin, end - begin);
    line_.remove_prefix(end);
    return found;
  }

  float number(const char* keyword) {
    const std::string_view found = word();
    if (found.empty()) refuse("'" + std::string(keyword) + "' has too few numbers.");
    const auto value = number_from(found);
    const auto refuse_it = [&](const char* why) {
      refuse(std::string("'").append(found.substr(0, 40)).append("' ").append(why));
    };
    if (!value) {
      const bool comma = found.find(',') != std::string_view::npos;
      refuse_it(comma ? "is not a number; use a point as the decimal separator." : "is not a number.");
    }
    const auto rounded = static_cast<float>(*value);
    // The words inf and nan stand for missing values; Mesh leaves out triangles that have them.
    if (std::isinf(rounded) && found.find_first_of("123456789") != std::string_view::npos)
      refuse_it("is too large; use smaller units.");
    return rounded;
  }

  Vec3 vector(const char* keyword) {
    const float x = number(keyword), y = number(keyword), z = number(keyword);
    return {x, y, z};
  }

  void read_uv() {
    const float u = number("vt");
    const std::string_view before = line_;
    const bool has_v = !word().empty();
    line_ = before;
    content_.uvs.push_back({u, has_v ? number("vt") : 0.0f});
  }

  /// Follows Blender's importer: names that are no number ("on", "null") also turn smoothing off.
  void read_smoothing() {
    const std::string_view group = word();
    if (group.empty()) return;
    const size_t plus = group.starts_with('+') ? 1 : 0;
    int number = 0;
    std::from_chars(group.data() + plus, group.data() + group.size(), number);
    smooth_ = number != 0;
  }

  /// Converts an index of the file, counted from 1 or, if negative, from the end of the `count` entries so far, to one
  /// counted from 0.
  uint32_t place(std::string_view text, size_t count, const char* what) const {
    int64_t index = 0;
    const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc() || end != digits.data() + digits.size() || index == 0 || index > INT32_MAX ||
        index < -INT32_MAX)
      refuse("'" + std::string(text.substr(0, 40)) + "' is not a valid " + what + " index.");
    if (index > 0) return static_cast<uint32_t>(index - 1);
    if (-index > static_cast<int64_t>(count))
      refuse("a face has " + std::string(what) + " index " + std::to_string(index) + ", but the file has only " +
             std::to_string(count) + " up to this line.");
    return static_cast<uint32_t>(static_cast<int64_t>(count) + index);
  }

  ObjCorner corner(std::string_view text) const {
    const size_t first = std::min(text.find('/'), text.size()),
                 second = std::min(text.find('/', first + 1), text.size());
    const auto part = [&](size_t begin, size_t end) {
      return begin < end ? text.substr(begin, end - begin) : std::string_view();
    };
    const std::string_view uv = part(first + 1, second), normal = part(second + 1, text.size());
    return {place(text.substr(0, first), content_.positions.size(), "vertex"),
            uv.empty() ? kNone : place(uv, content_.uvs.size(), "texture coordinate"),
            normal.empty() ? kNone : place(normal, content_.normals.size(), "normal")};
  }

  void read_face() {
    const auto first = static_cast<uint32_t>(content_.corners.size());
    for (std::string_view text = word(); !text.empty(); text = word()) content_.corners.push_back(corner(text));
    const size_t count = content_.corners.size() - first;
    if (count > PolygonTriangles::kMaxCorners)
      refuse("a face has " + std::to_string(count) + " corners, more than " +
             std::to_string(PolygonTriangles::kMaxCorners) + ". Split it into smaller faces.");
    if (count < 3) {
      ++content_.too_small;
      content_.corners.resize(first);
      return;
    }
    face_lines_.push_back(line_number_);
    content_.faces.push_back({first, static_cast<uint32_t>(count), smooth_});
  }

  /// Done at the end, because faces may name entries that come later in the file.
  void check_indices() {
    const auto check = [&](uint32_t place, size_t count, const char* what) {
      if (place != kNone && place >= count)
        refuse("a face has " + std::string(what) + " index " + std::to_string(uint64_t{place} + 1) +
               ", but the file has only " + std::to_string(count) + ".");
    };
    for (size_t f = 0; f < content_.faces.size(); ++f) {
      line_number_ = face_lines_[f];
      const ObjContent::Face& face = content_.faces[f];
      for (const ObjCorner& c : std::span(content_.corners).subspan(face.first, face.count)) {
        check(c.position, content_.positions.size(), "vertex");
        check(c.uv, content_.uvs.size(), "texture coordinate");
        check(c.normal, content_.normals.size(), "normal");
      }
    }
  }

  std::string_view text_, line_;
  std::string joined_;  // a line joined from several, which `line_` refers to
  const std::string& path_;
  size_t at_ = 0;
  uint64_t lines_read_ = 0, line_number_ = 0;
  bool smooth_ = false;  // smoothing groups are off unless named (Wavefront, "Object Files", B1)
  ObjContent content_;
  std::vector<uint64_t> face_lines_;
};

/// Arrays for a Mesh, apart from the positions.
struct ObjArrays {
  std::vector<glm::uvec3> triangles;  // corner indices
  std::vector<uint32_t> corner_vertices;
  std::vector<Vec3> corner_normals;
  std::vector<Vec2> corner_uvs;
  std::vector<uint8_t> smooth;
  size_t without_normals = 0, without_uvs = 0;  // numbers of faces

  explicit ObjArrays(const ObjContent& content) {
    for (const ObjCorner& corner : content.corners) corner_vertices.push_back(corner.position);
    for (const ObjContent::Face& face : content.faces) {
      cut(content, face);
      add_attributes(content, std::span(content.corners).subspan(face.first, face.count));
    }
    if (without_normals == content.faces.size()) corner_normals.clear();
    if (without_uvs == content.faces.size()) corner_uvs.clear();
  }

 private:
  void cut(const ObjContent& content, const ObjContent::Face& face) {
    polygon_.clear();
    for (uint32_t i = 0; i < face.count; ++i) polygon_.push_back(content.positions[corner_vertices[face.first + i]]);
    for (const glm::uvec3& triangle : cutter_.cut(polygon_)) {
      triangles.push_back(triangle + glm::uvec3(face.first));
      smooth.push_back(face.smooth);
    }
  }

  /// A face with attributes at only some corners counts as having none; zero normals stand for the triangle's own.
  void add_attributes(const ObjContent& content, std::span<const ObjCorner> face) {
    const bool normals = std::ranges::none_of(face, [](const ObjCorner& c) { return c.normal == kNone; });
    const bool uvs = std::ranges::none_of(face, [](const ObjCorner& c) { return c.uv == kNone; });
    without_normals += !normals;
    without_uvs += !uvs;
    for (const ObjCorner& corner : face) {
      corner_normals.push_back(normals ? content.normals[corner.normal] : Vec3(0.0f));
      corner_uvs.push_back(uvs ? content.uvs[corner.uv] : Vec2(0.0f));
    }
  }

  PolygonTriangles cutter_;
  std::vector<Vec3> polygon_;
};

void add_warnings(const ObjContent& content, const ObjArrays& arrays, const std::string& path, Mesh& mesh) {
  const size_t all = content.faces.size();
  const auto some = [&](size_t faces) { return faces > 0 && faces < all; };
  if (const size_t faces = arrays.without_normals; some(faces)) {
    mesh.add_warning(warning<WarningCode::faces_without_normals>({{"file", path}, {"faces", faces}, {"all", all}}));
  }
  if (const size_t faces = arrays.without_uvs; some(faces)) {
    mesh.add_warning(warning<WarningCode::faces_without_uvs>({{"file", path}, {"faces", faces}, {"all", all}}));
  }
  if (const size_t faces = content.too_small; faces > 0) {
    mesh.add_warning(warning<WarningCode::faces_left_out>({{"file", path}, {"faces", faces}}));
  }
}

}  // namespace

Mesh read_obj(const std::string& path) {
  const std::vector<uint8_t> bytes = read_file(path);
  const ObjContent content = ObjReader(bytes, path).read();
  if (content.faces.empty()) throw Error(Status::bad_data, path + ": contains no faces.");
  const ObjArrays arrays(content);
  Mesh mesh({.positions = content.positions,
             .triangles = arrays.triangles,
             .corner_normals = arrays.corner_normals,
             .corner_uvs = arrays.corner_uvs,
             .smooth = arrays.smooth,
             .corner_vertices = arrays.corner_vertices});
  add_warnings(content, arrays, path, mesh);
  return mesh;
}

}  // namespace velour
