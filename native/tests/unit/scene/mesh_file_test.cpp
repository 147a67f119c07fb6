// Formats of meshes, recognized by content.
#include "scene/mesh_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "base/error.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::mesh_file_test {
namespace {

std::string written(const std::string& bytes, const std::string& name = "mesh.obj") {
  const auto path = test::scratch_root() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

std::string refusal(const std::string& path) {
  try {
    read_mesh(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(MeshFile, PlyOfAnyName) {
  test::record_input("PLY", "named .obj or without an extension", "read");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* name : {"ply.obj", "ply", "ply.PLY"})
    EXPECT_EQ(read_mesh(written(ply, name)).triangles().size(), 1u);
  EXPECT_NE(refusal(written("v 0 0 0\n", "obj.ply")).find("is not a PLY file. If it is an OBJ file, rename it."),
            std::string::npos);
}

TEST(MeshFile, OtherFormatsAreNamed) {
  test::record_input("Others", "STL, glTF, FBX, OFF, USD, COLLADA, VRML, Alembic, .blend as meshes", "refused by name");
  test::record_input("OBJ", "UTF-16; compressed (ZIP, gzip)", "refused: save as UTF-8; unpack");
  std::string binary_stl(84 + 2 * 50, '\0');
  binary_stl[80] = 2;
  const std::string zero(1, '\0'), save = "; export the mesh as OBJ or PLY.";
  const std::pair<std::string, std::string> others[] = {
      {"solid x\nfacet normal 0 0 1\n", "is an STL file, which Velour cannot read" + save},
      {binary_stl, "is an STL file, which Velour cannot read" + save},
      {"glTF\2", "is a GLB file (glTF), which Velour cannot read" + save},
      {"{\"asset\": {}}", "is a JSON file, for example glTF, which Velour cannot read" + save},
      {"Kaydara FBX Binary  ", "is an FBX file, which Velour cannot read" + save},
      {"OFF\n3 1 0\n", "is an OFF file, which Velour cannot read" + save},
      {"#usda 1.0\n", "is a USD file, which Velour cannot read" + save},
      {"PXR-USDC", "is a USD file, which Velour cannot read" + save},
      {"PK\3\4", "is a ZIP archive, for example USDZ, which Velour cannot read; unpack it, or export"},
      {"\xff\xfev" + zero + " " + zero, "is text in UTF-16, which Velour cannot read; save it as UTF-8."},
      {"v" + zero + " " + zero, "is text in UTF-16, which Velour cannot read; save it as UTF-8."},
  };
  for (const auto& [bytes, sentence] : others) {
    const std::string path = written(bytes);
    EXPECT_TRUE(refusal(path).starts_with(path + ": " + sentence)) << refusal(path);
  }
}

TEST(MeshFile, PipesAreRefused) {
  const std::string pipe = (test::scratch_folder() / "pipe.obj").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe), pipe + ": is not a regular file; choose a file.");
}

}  // namespace
}  // namespace velour::mesh_file_test
