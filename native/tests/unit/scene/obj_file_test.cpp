// Wavefront OBJ as other programs write it.
#include "scene/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "support/inputs.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::obj_file_test {
namespace {

std::string write_text(const std::string& text) {
  const std::string path = (test::scratch_folder() / "mesh.obj").string();
  std::ofstream(path) << text;
  return path;
}

TEST(ObjFile, ReadsPolygonsNormalsAndTextureCoordinates) {
  const Mesh mesh =
      read_obj(write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                          "f 1/1/1 2/2/1 3/3/1 4/4/1\n"));
  EXPECT_EQ(mesh.triangles().size(), 2u);
  EXPECT_EQ(mesh.shading_normal(0, {0.2f, 0.2f}), Vec3(0, 1, 0));
  EXPECT_TRUE(mesh.has_uvs());
  EXPECT_NEAR(mesh.tangent(0).x, 1, 1e-6f);
}

TEST(ObjFile, RefusesWhatLies) {
  for (const char* text : {"", "v 0 0 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2000000000\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 -8 -7\n", "f f f\nv v v\n", "\x7f\x45LF\x02\x01\x01"}) {
    const std::string path = write_text(text);
    try {
      read_obj(path);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::bad_data);
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    }
  }
  EXPECT_THROW(read_obj("/no/such/file.obj"), Error);
}

/// Its negative is no number of 64 bits; as a place of 32 bits it would be the vertex after the face.
TEST(ObjFile, RefusesTheMostNegativeIndex) {
  EXPECT_THROW(read_obj(write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9223372036854775808\nv 1 1 0\n")), Error);
  EXPECT_EQ(read_obj(write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -1\nv 1 1 0\n")).triangles().size(), 1u);
}

TEST(ObjFile, ReadsTheBunny) {
  VELOUR_NEED_DATA(path, "mesh/bunny.obj");
  const Mesh mesh = read_obj(path.string());
  EXPECT_EQ(mesh.triangles().size() + mesh.dropped(), 69451u);
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const glm::uvec3& t : mesh.triangles()) {
    const Vec3d a(mesh.positions()[t[0]]), b(mesh.positions()[t[1]]), c(mesh.positions()[t[2]]);
    area += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return area;
}

/// Whether the point lies in one of the triangles, seen along z.
bool covers(const Mesh& mesh, double x, double y) {
  for (const glm::uvec3& t : mesh.triangles()) {
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const Vec3d a(mesh.positions()[t[k]]), b(mesh.positions()[t[(k + 1) % 3]]);
      inside = inside && (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) >= 0;
    }
    if (inside) return true;
  }
  return false;
}

/// An L whose notch is the upper right, from each of its corners on, near the origin and far from it.
TEST(ObjFile, ConcavePolygonsKeepTheirNotch) {
  test::record_input("OBJ", "concave polygons, from any corner on, anywhere", "read");
  const double corners[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double far : {0.0, 3000.0})
    for (int first = 0; first < 6; ++first) {
      std::string text, face = "f";
      for (int i = 0; i < 6; ++i) {
        const double* c = corners[(first + i) % 6];
        text += "v " + std::to_string(c[0] + far) + " " + std::to_string(c[1] - far) + " 5\n";
        face += " " + std::to_string(i + 1);
      }
      const Mesh mesh = read_obj(write_text(text + face + "\n"));
      EXPECT_EQ(mesh.triangles().size(), 4u);
      EXPECT_NEAR(area_of(mesh), 3.0, 1e-9);
      EXPECT_FALSE(covers(mesh, far + 1.5, 1.5 - far)) << first;
      EXPECT_TRUE(covers(mesh, far + 0.5, 1.5 - far)) << first;
    }
}

TEST(ObjFile, ConcaveQuads) {
  for (int first = 0; first < 4; ++first) {
    const double dart[4][2] = {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}};
    std::string text;
    for (int i = 0; i < 4; ++i)
      text += "v " + std::to_string(dart[(first + i) % 4][0]) + " " + std::to_string(dart[(first + i) % 4][1]) + " 0\n";
    const Mesh mesh = read_obj(write_text(text + "f 1 2 3 4\n"));
    EXPECT_NEAR(area_of(mesh), 1.5, 1e-9) << first;
    EXPECT_FALSE(covers(mesh, 0.2, 1)) << first;
  }
}

const std::string kTwoSquares = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";

TEST(ObjFile, FacesKeepWhatTheyName) {
  test::record_input("OBJ", "faces with and without normals or texture coordinates", "each keeps its own; counted");
  const std::string mixed = kTwoSquares + "vn 0 1 0\nvt 0.25 0.5\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 2 5 6 3\n";
  const Mesh mesh = read_obj(write_text(mixed));
  ASSERT_EQ(mesh.triangles().size(), 4u);
  EXPECT_EQ(mesh.shading_normal(0, {0.2f, 0.2f}), Vec3(0, 1, 0));
  EXPECT_EQ(mesh.shading_normal(2, {0.2f, 0.2f}), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.corner_uvs(0)[0], Vec2(0.25f, 0.5f));
  EXPECT_EQ(mesh.corner_uvs(2)[0], Vec2(0));
  ASSERT_EQ(mesh.warnings().size(), 2u);
  EXPECT_EQ(mesh.warnings()[0].code, WarningCode::faces_without_normals);
  EXPECT_EQ(mesh.warnings()[1].code, WarningCode::faces_without_uvs);
  for (const Warning& told : mesh.warnings()) {
    EXPECT_EQ(test::value_of<uint64_t>(told, "faces"), 1u);
    EXPECT_EQ(test::value_of<uint64_t>(told, "all"), 2u);
  }
}

TEST(ObjFile, AllWaysToNameACorner) {
  test::record_input("OBJ", "1//, 1/1, 1//1, 1/1/, negative and signed indices, continued lines, faces before vertices",
                     "read");
  const std::string lists = kTwoSquares + "vt 0.5 0.5 0\nvn 0 0 -1\n";
  for (const char* face : {"f 1// 2// 3//", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f -6/-1/-1 -5/-1/-1 -4/-1/-1",
                           "f 1/1/ 2/1/ 3/1/", "f +1 +2 +3", "f 1 2 3 # 4", "f 1 \\\n 2 \\\r\n 3"}) {
    const Mesh mesh = read_obj(write_text(lists + face + "\n"));
    ASSERT_EQ(mesh.triangles().size(), 1u) << face;
    EXPECT_EQ(mesh.triangles()[0], glm::uvec3(0, 1, 2)) << face;
  }
  // Vertices may come later in the file.
  EXPECT_EQ(read_obj(write_text("f 1 2 3\n" + kTwoSquares)).triangles().size(), 1u);
}

/// Two squares of a roof: flat without a smoothing group, smooth in one, and flat again behind "s off".
TEST(ObjFile, SmoothingGroups) {
  test::record_input("OBJ", "smoothing groups without normals", "smooth in a group, else flat");
  const std::string roof = "v 0 0 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nv 2 1 0\n";
  const std::string faces = "f 1 3 4 2\nf 3 5 6 4\n";
  const auto bends = [](const Mesh& mesh) {
    return glm::length(mesh.shading_normal(0, {0.9f, 0.05f}) - mesh.shading_normal(0, {0.05f, 0.05f})) > 0.1f;
  };
  EXPECT_FALSE(bends(read_obj(write_text(roof + faces))));
  EXPECT_FALSE(bends(read_obj(write_text(roof + "s off\n" + faces))));
  EXPECT_FALSE(bends(read_obj(write_text(roof + "s 0\n" + faces))));
  EXPECT_TRUE(bends(read_obj(write_text(roof + "s 1\n" + faces))));
  EXPECT_FALSE(bends(read_obj(write_text(roof + "s 1\ns off\n" + faces))));
  EXPECT_TRUE(bends(read_obj(write_text(roof + "g a\ns 1\ng b\nusemtl c\n" + faces))));
  test::record_input("OBJ", "s on, s null; s 1 before the next o", "flat, as in Blender");
  for (const char* flat : {"s on\n", "s null\n", "s 00\n", "s 99999999999\n", "s 1\no b\n"})
    EXPECT_FALSE(bends(read_obj(write_text(roof + flat + faces)))) << flat;
  for (const char* smooth : {"s +1\n", "s 1.5\n", "s 2 off\n", "s 1\ns\n", "s 1\no\n"})
    EXPECT_TRUE(bends(read_obj(write_text(roof + smooth + faces)))) << smooth;
}

TEST(ObjFile, LineEndsMarksAndSigns) {
  test::record_input("OBJ", "LF, CRLF, CR; UTF-8 mark; +1.0; vertex colors", "read");
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string text = "\xef\xbb\xbf# from C:\\models\\";
    for (const char* line :
         {"", "v +0 0. 0e0", "v +1.0 0 0 1", "v\t0  1 0 0.5 0.5 0.5", "g a b", "usemtl \\x", "f 1 2 3"})
      text += std::string(line) + end;
    EXPECT_EQ(read_obj(write_text(text)).position(0, {1, 0}), Vec3(1, 0, 0)) << int(end[0]);
  }
}

TEST(ObjFile, NamesTheLineOfAFault) {
  test::record_input("OBJ", "decimal commas, indices of nothing, numbers beyond float32", "refused with the line");
  const std::pair<const char*, const char*> faults[] = {
      {"v 0 0 0\nv 1,5 0 0\n", "line 2: '1,5' is not a number"},
      {"v 0 0\n", "line 1: 'v' has too few"},
      {"v 0 0 0\nv 1e400 0 0\n", "line 2: '1e400' is too large; use smaller units"},
      {"v 0 -1e39 0\n", "line 1: '-1e39' is too large"},
      {"v 1 1e-400 0\nvt 1 1e999\n", "line 2: '1e999' is too large"},
      {"v 0 0 0\n\nf 1 0 1\n", "line 3: '0' is not a valid vertex index"},
      {"v 0 0 0\nf 1 1.5 1\n", "line 2: '1.5' is not a valid vertex index"},
      {"v 0 0 0\r\nf 1 2 1\r\n", "line 2: a face has vertex index 2, but the file has only 1"},
      {"v 0 0 0\nf 1 -2 1\n", "line 2: a face has vertex index -2"},
      {"v 0 0 0\nf 1/1 1/1 1/1\n", "line 2: a face has texture"}};
  for (const auto& [text, sentence] : faults) {
    try {
      read_obj(write_text(text));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace velour::obj_file_test
