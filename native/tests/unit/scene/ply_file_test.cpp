#include "scene/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/process.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::ply_file_test {
namespace {

std::string written(const std::string& bytes, const std::string& name = "mesh.ply") {
  const auto path = test::scratch_root() / name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

const std::string kHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
std::string ascii() {
  std::string bytes = "ply\nformat ascii 1.0\ncomment a square\n";
  bytes += kHeader;
  return bytes.append("0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n");
}
const std::string kAscii = ascii();

template <typename T>
void append(std::string& to, T value, bool big) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big) std::reverse(raw.begin(), raw.end());
  for (const char c : raw) to.push_back(c);
}

std::string binary(bool big) {
  std::string bytes = big ? "ply\nformat binary_big_endian 1.0\n" : "ply\nformat binary_little_endian 1.0\n";
  bytes += kHeader;
  for (const int x : {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1, 1, 0, 1, 0, 0, 1})
    append(bytes, static_cast<float>(x), big);
  append(bytes, uint8_t{4}, big);
  for (const int i : {0, 1, 2, 3}) append(bytes, i, big);
  return bytes;
}

TEST(PlyFile, ReadsAllFormatsAlike) {
  test::record_input("PLY", "ascii, both byte orders", "read");
  for (const std::string& bytes : {kAscii, binary(false), binary(true)}) {
    const Mesh mesh = read_mesh(written(bytes));
    ASSERT_EQ(mesh.triangles().size(), 2u);
    EXPECT_EQ(mesh.position(1, {0, 1}), Vec3(0, 1, 0));
    EXPECT_TRUE(mesh.has_uvs());
  }
}

TEST(PlyFile, SkipsWhatItDoesNotKnow) {
  const std::string bytes =
      "ply\nformat ascii 1.0\nelement camera 2\nproperty double focus\nelement vertex 3\nproperty double y\n"
      "property uchar red\nproperty double x\nproperty double z\nelement face 1\nproperty list uchar float weights\n"
      "property list uint8 uint32 vertex_index\nproperty short group\nend_header\n"
      "5 6\n0 255 0 0\n0 255 1 0\n1 255 0 0\n2 0.5 0.25\n3 0 1 2\n7\n";
  EXPECT_FALSE(read_ply(written(bytes)).has_uvs());
  EXPECT_EQ(read_ply(written(bytes)).position(0, {1, 0}), Vec3(1, 0, 0));
}

TEST(PlyFile, EveryTruncationIsASentence) {
  for (const std::string& bytes : {kAscii, binary(false)}) {
    for (size_t n = 0; n + 2 < bytes.size(); ++n) {
      EXPECT_THROW(read_ply(written(bytes.substr(0, n))), Error) << n;
    }
  }
}

std::string with(const std::string& what, const std::string& instead) {
  const size_t at = kAscii.find(what);
  std::string bytes(kAscii, 0, at);
  bytes += instead;
  return bytes.append(kAscii, at + what.size());
}

TEST(PlyFile, RefusesLies) {
  for (const std::string& bytes :
       {with("vertex 4", "vertex 4000000000000"), with("vertex 4", "vertex -4"), with("face 1", "face 99999"),
        with("4 0 1 2 3", "4 0 1 2 4"), with("4 0 1 2 3", "4 0 1 2 -1"), with("4 0 1 2 3", "255 0 1 2 3"),
        with("4 0 1 2 3", "-4 0 1 2 3"), with("4 0 1 2 3", "1e300 0 1 2 3"), with("4 0 1 2 3", "nan 0 1 2 3"),
        with("face 1", "face 18446744073709551615"), with("4 0 1 2 3", "4 0 1 2 x"), with("float z", "float depth"),
        with("uchar int", "uchar text"), with("ascii", "binary_middle_endian"),
        with("element face 1", "element faces 1"), std::string("property float x\nend_header\n")}) {
    EXPECT_THROW(read_ply(written(bytes)), Error) << bytes;
  }
  EXPECT_THROW(read_ply("/nowhere/at_all.ply"), Error);
}

TEST(PlyFile, ElementsInAnyOrderLineEndsAndSigns) {
  test::record_input("PLY", "faces before vertices; LF, CRLF, CR; +1.0", "read");
  const std::string faces_first =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n+0 0 0\n+1.0 0 0\n0 1 0\n";
  EXPECT_EQ(read_ply(written(faces_first)).position(0, {1, 0}), Vec3(1, 0, 0));
  for (const std::string& end : {std::string("\r"), std::string("\r\n")}) {
    std::string bytes;
    for (const char c : faces_first) bytes += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(read_ply(written(bytes)).triangles().size(), 1u);
  }
}

TEST(PlyFile, ConcaveQuadsAndCoordinatesOfCorners) {
  test::record_input("PLY", "concave quads, texcoord lists of corners", "read");
  const std::string bytes =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
      "0 0 0\n2 1 0\n0 2 0\n0.5 1 0\n4 0 1 2 3 8 0 0 1 0.5 0 1 0.25 0.5\n3 0 1 2 0\n";
  const Mesh mesh = read_ply(written(bytes));
  ASSERT_EQ(mesh.triangles().size(), 3u);
  for (uint32_t t = 0; t < 2; ++t) {
    const glm::uvec3 corner = mesh.triangles()[t];
    EXPECT_TRUE(corner[0] == 3 || corner[1] == 3 || corner[2] == 3);
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(mesh.corner_uvs(t)[static_cast<size_t>(k)].x, mesh.positions()[corner[k]].x / 2);
  }
  EXPECT_EQ(mesh.corner_uvs(2)[1], Vec2(0));
}

TEST(PlyFile, TriangleStrips) {
  test::record_input("PLY", "triangle strips (tristrips), alone or beside faces", "read");
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  // Two triangles, a new strip, and two triangles behind two that connect them.
  const std::string strip = "12 0 1 2 3 -1 2 3 4 4 4 3 5\n";
  const Mesh alone = read_ply(written(head + strips + "end_header\n" + points + strip));
  ASSERT_EQ(alone.triangles().size(), 4u);
  EXPECT_EQ(alone.dropped(), 0u);
  for (uint32_t t = 0; t < 4; ++t) EXPECT_GT(alone.shading_normal(t, {0.3f, 0.3f}).z, 0.9f) << t;
  const std::string face =
      "element face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n";
  const Mesh mixed =
      read_ply(written(head + strips + face + "end_header\n" + points + "4 0 1 2 3\n3 2 3 5 6 0 0.5 0 0.5 0 0.5\n"));
  ASSERT_EQ(mixed.triangles().size(), 3u);
  EXPECT_EQ(mixed.corner_uvs(1)[0], Vec2(0));
  EXPECT_EQ(mixed.corner_uvs(2)[0], Vec2(0, 0.5f));
  EXPECT_THROW(read_ply(written(head + strips + "end_header\n" + points + "4 0 1 2 -2\n")), Error);
}

TEST(PlyFile, RefusesNumbersBeyondDouble) {
  test::record_input("PLY", "numbers beyond float64", "refused with the byte");
  std::string bytes = kAscii;
  const size_t at = bytes.find("1 0 0 1 0\n");
  bytes.replace(at, 1, "1e400");
  const std::string path = written(bytes);
  try {
    read_ply(path);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(),
              path + ": the number '1e400' at byte " + std::to_string(at) + " is too large; use smaller units.");
  }
  bytes.replace(at, 5, "1e-400");
  EXPECT_EQ(read_ply(written(bytes)).positions()[1], Vec3(0));
}

// The corners of a second list would look for normals and uvs that only the first has.
TEST(PlyFile, TheLastLineNeedsNoEnd) {
  test::record_input("PLY", "ascii without a line end at the end", "read");
  const std::string bytes =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  EXPECT_EQ(read_ply(written(bytes)).triangles().size(), 1u);
  EXPECT_THROW(read_ply(written(bytes.substr(0, bytes.size() - 1))), Error);
}

TEST(PlyFile, ManyElementsTakeNoTime) {
  std::string bytes = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 100000; ++i) bytes.append("element e").append(std::to_string(i)).append(" 0\n");
  bytes.append(kAscii, kAscii.find("element vertex"));
  const double start = thread_seconds();
  EXPECT_EQ(read_ply(written(bytes)).triangles().size(), 2u);
  EXPECT_LT(thread_seconds() - start, 1.0);
}

TEST(PlyFile, RefusesTwoElementsOfOneName) {
  const std::string more_vertices = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  std::string vertices = with("element face", more_vertices + "element face");
  vertices.replace(vertices.find("4 0 1 2 3"), 9, "7 7 7\n4 0 1 2 4");
  std::string faces = with("end_header", "element face 1\nproperty list uchar int vertex_indices\nend_header");
  faces += "3 0 1 2\n";
  for (const auto& [bytes, name] : {std::pair{vertices, "'vertex'"}, std::pair{faces, "'face'"}}) {
    try {
      read_ply(written(bytes));
      ADD_FAILURE() << bytes;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace velour::ply_file_test
