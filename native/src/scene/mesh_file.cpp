#include "scene/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include "base/parallel.h"

namespace velour {

Mesh read_mesh(const std::string& path) {
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
