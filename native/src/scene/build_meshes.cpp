#include "scene/build_meshes.h"

#include <algorithm>
#include <iterator>

#include "job/parallel.h"

namespace velour {

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
