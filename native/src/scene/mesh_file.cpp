#include "scene/mesh_file.h"

#include <algorithm>
#include <cctype>

#include "scene/obj_file.h"
#include "scene/ply_file.h"

namespace velour {

Mesh read_mesh(const std::string& path) {
  std::string end = path.size() < 4 ? "" : path.substr(path.size() - 4);
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".ply" ? read_ply(path) : read_obj(path);
}

}  // namespace velour
