#include "scene/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <string_view>
#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"

namespace velour {

namespace {

using namespace std::string_view_literals;

/// Formats that users may try.
struct OtherFormat {
  std::string_view begin;  // first bytes of the file
  const char* name;
  const char* remedy = "export the mesh as OBJ or PLY.";
};

constexpr const char* kUtf16 = "text in UTF-16";
constexpr const char* kSaveAsUtf8 = "save it as UTF-8.";

constexpr OtherFormat kOtherFormats[] = {
    {"solid", "an STL file"},
    {"glTF", "a GLB file (glTF)"},
    {"{", "a JSON file, for example glTF"},
    {"Kaydara FBX Binary", "an FBX file"},
    {"; FBX", "an FBX file"},
    {"OFF", "an OFF file"},
    {"COFF", "an OFF file"},
    {"NOFF", "an OFF file"},
    {"#usda", "a USD file"},
    {"PXR-USDC", "a USD file"},
    {"PK\x03\x04", "a ZIP archive, for example USDZ", "unpack it, or export the mesh as OBJ or PLY."},
    {"\x1f\x8b", "a compressed file (gzip)", "unpack it."},
    {"<?xml", "an XML file, for example COLLADA"},
    {"#VRML", "a VRML file"},
    {"Ogawa", "an Alembic file"},
    {"BLENDER", "a .blend file"},
    {"\xff\xfe", kUtf16, kSaveAsUtf8},
    {"\xfe\xff", kUtf16, kSaveAsUtf8},
    {"#\0"sv, kUtf16, kSaveAsUtf8},
    {"v\0"sv, kUtf16, kSaveAsUtf8},
};

/// A binary STL file has no mark: 80 free bytes, the number of triangles, and 50 bytes for each.
bool is_binary_stl(std::string_view head, uint64_t file_size) {
  if (head.size() < 84) return false;
  uint64_t triangles = 0;
  for (size_t i = 4; i-- > 0;) triangles = triangles << 8 | static_cast<uint8_t>(head[80 + i]);
  return file_size == 84 + 50 * triangles;
}

void refuse_other_formats(const std::string& path, std::string_view head, uint64_t file_size) {
  const auto* found =
      std::ranges::find_if(kOtherFormats, [&](const OtherFormat& other) { return head.starts_with(other.begin); });
  if (found == std::end(kOtherFormats) && is_binary_stl(head, file_size)) found = kOtherFormats;
  if (found == std::end(kOtherFormats)) return;
  throw Error(Status::unsupported, path + ": is " + found->name + ", which Velour cannot read; " + found->remedy);
}

bool begins_as_ply(std::string_view head) { return head.starts_with("ply\n") || head.starts_with("ply\r"); }

}  // namespace

Mesh read_mesh(const std::string& path) {
  std::array<uint8_t, 84> bytes{};
  const RandomAccessFile file(path);
  const size_t size = std::min<uint64_t>(bytes.size(), file.size());
  file.read(0, std::span(bytes).first(size));
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), size);
  if (begins_as_ply(head)) return read_ply(path);
  refuse_other_formats(path, head, file.size());
  std::string end = path.size() < 4 ? "" : path.substr(path.size() - 4);
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".ply" ? read_ply(path) : read_obj(path);
}

std::vector<Mesh> build_meshes(std::span<const MeshArrays> arrays) {
  constexpr size_t kMeshesOfPiece = 64;  // meshes per task: in scenes with many, most are small
  std::vector<std::vector<Mesh>> built((arrays.size() + kMeshesOfPiece - 1) / kMeshesOfPiece);
  const Progress unwatched;
  parallel_pieces(built.size(), 0, unwatched, [&](size_t piece) {
    const size_t begin = piece * kMeshesOfPiece;
    const auto own = arrays.subspan(begin, std::min(kMeshesOfPiece, arrays.size() - begin));
    built[piece] = std::vector<Mesh>(own.begin(), own.end());
  });
  std::vector<Mesh> all;
  all.reserve(arrays.size());
  for (std::vector<Mesh>& piece : built) {
    all.insert(all.end(), std::make_move_iterator(piece.begin()), std::make_move_iterator(piece.end()));
  }
  return all;
}

}  // namespace velour
