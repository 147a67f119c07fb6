#include "scene/obj_file.h"

#include <fstream>

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include "job/error.h"

namespace velour {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(Status::bad_data, path + ": " + why);
}

/// The file's index `index` of `field`, checked against what the file holds.
size_t checked(const std::string& path, int index, size_t count, const char* field) {
  if (index < 0 || static_cast<size_t>(index) >= count) {
    refuse(path, "a face names " + std::string(field) + " " + std::to_string(static_cast<long long>(index) + 1) +
                     " of " + std::to_string(count) + ".");
  }
  return static_cast<size_t>(index);
}

struct Corners {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<glm::uvec3> triangles;
};

void add_corner(const std::string& path, const tinyobj::attrib_t& file, const tinyobj::index_t& index, Corners& out) {
  if (index.normal_index >= 0) {
    const size_t n = 3 * checked(path, index.normal_index, file.normals.size() / 3, "normal");
    out.normals.push_back({file.normals[n], file.normals[n + 1], file.normals[n + 2]});
  }
  if (index.texcoord_index >= 0) {
    const size_t t = 2 * checked(path, index.texcoord_index, file.texcoords.size() / 2, "texture coordinate");
    out.uvs.push_back({file.texcoords[t], file.texcoords[t + 1]});
  }
}

Corners gather(const std::string& path, const tinyobj::attrib_t& file, const std::vector<tinyobj::shape_t>& shapes) {
  Corners out;
  for (size_t i = 0; i + 2 < file.vertices.size(); i += 3) {
    out.positions.push_back({file.vertices[i], file.vertices[i + 1], file.vertices[i + 2]});
  }
  for (const tinyobj::shape_t& shape : shapes) {
    const auto& indices = shape.mesh.indices;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
      glm::uvec3 triangle;
      for (size_t k = 0; k < 3; ++k) {
        const size_t vertex = checked(path, indices[i + k].vertex_index, out.positions.size(), "vertex");
        triangle[static_cast<int>(k)] = static_cast<uint32_t>(vertex);
        add_corner(path, file, indices[i + k], out);
      }
      out.triangles.push_back(triangle);
    }
  }
  // All corners or none: a file that names only some normals gets smooth ones.
  if (out.normals.size() != 3 * out.triangles.size()) out.normals.clear();
  if (out.uvs.size() != 3 * out.triangles.size()) out.uvs.clear();
  return out;
}

}  // namespace

Mesh read_obj(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) throw Error(Status::io, path + ": cannot be opened.");
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, problem;
  const bool parsed =
      tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &problem, &stream, nullptr, true, false);
  if (!parsed) refuse(path, problem.empty() ? "is not a Wavefront OBJ file." : problem);
  const Corners corners = gather(path, attributes, shapes);
  if (corners.triangles.empty()) refuse(path, "holds no faces.");
  return Mesh({corners.positions, corners.triangles, corners.normals, corners.uvs, {}, {}});
}

}  // namespace velour
