// BSDF XML files of Radiance and WINDOW, made here.
#include "brdf/formats/window_bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "base/file.h"
#include "brdf/formats/bsdf_xml.h"
#include "brdf/measure/spectrum.h"
#include "math/sphere/directions.h"
#include "measurement_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::window_bsdf_test {
namespace {

using Value = std::function<double(uint32_t light, uint32_t view)>;

/// Six rings of eight patches and a cap: 49.
constexpr uint32_t kPatches = 49;
std::string own_basis() {
  std::string text = "<AngleBasis><AngleBasisName>Own</AngleBasisName>";
  const double edges[] = {0, 5, 20, 35, 50, 65, 80, 90};
  for (int ring = 0; ring < 7; ++ring) {
    text += "<AngleBasisBlock><nPhis>" + std::to_string(ring == 0 ? 1 : 8) + "</nPhis><ThetaBounds><LowerTheta>" +
            std::to_string(edges[ring]) + "</LowerTheta><UpperTheta>" + std::to_string(edges[ring + 1]) +
            "</UpperTheta></ThetaBounds></AngleBasisBlock>";
  }
  return text + "</AngleBasis>";
}

struct Block {
  std::string wavelength = "Visible", direction = "Reflection Front", basis = "Own";
  uint32_t patches = kPatches;
};

std::string block_of(const Block& b, const Value& value, bool rows_of_light) {
  std::string text = "<WavelengthData><Wavelength unit=\"Integral\">" + b.wavelength +
                     "</Wavelength><WavelengthDataBlock><WavelengthDataDirection>" + b.direction +
                     "</WavelengthDataDirection><ColumnAngleBasis>" + b.basis + "</ColumnAngleBasis><RowAngleBasis>" +
                     b.basis + "</RowAngleBasis><ScatteringDataType>BRDF</ScatteringDataType><ScatteringData>\n";
  for (uint32_t row = 0; row < b.patches; ++row) {
    for (uint32_t column = 0; column < b.patches; ++column) {
      text += std::to_string(rows_of_light ? value(row, column) : value(column, row)) + (row % 2 ? ", " : "\t");
    }
    text += '\n';
  }
  return text + "</ScatteringData></WavelengthDataBlock></WavelengthData>";
}

std::string document(const std::string& blocks, const std::string& structure = "Columns") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- by hand -->\n<WindowElement><Optical><Layer>"
         "<Material><Name>Linen</Name></Material><DataDefinition><IncidentDataStructure>" +
         structure + "</IncidentDataStructure>" + own_basis() + "</DataDefinition>" + blocks +
         "</Layer></Optical></WindowElement>";
}

std::string tree_block(const std::string& tree, const std::string& wavelength, const std::string& basis) {
  return "<WavelengthData><Wavelength>" + wavelength +
         "</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection Front</WavelengthDataDirection>"
         "<AngleBasis>" +
         basis + "</AngleBasis><ScatteringData>\n" + tree + "</ScatteringData></WavelengthDataBlock></WavelengthData>";
}

std::string tree_document(const std::string& tree, int dimensions, const std::string& basis = "LBNL/Shirley-Chiu") {
  return document(tree_block(tree, "Visible", basis), "TensorTree" + std::to_string(dimensions));
}

/// Each in a folder of its own: scripts/fuzz begins with them.
std::string written(const std::string& text) {
  static int count = 0;
  const std::filesystem::path folder = test::scratch_root() / "bsdf_xml" / std::to_string(++count);
  std::filesystem::create_directories(folder);
  const std::string path = folder / "linen.xml";
  write_file(path, std::vector<uint8_t>(text.begin(), text.end()));
  return path;
}

Rgb value_of(const Measurement& measurement, const Vec3& wv, const Vec3& wl) {
  Rgb f(-1);
  uint8_t valid = 0;
  measurement.eval(wv, {&wl, 1}, {&f, 1}, {&valid, 1});
  EXPECT_TRUE(valid);
  return f;
}

/// The center of a patch: ring 1 to 6 (0 is the cap), eight azimuths.
Vec3 center(int ring, int place) {
  constexpr float kCenters[] = {0, 12.5f, 27.5f, 42.5f, 57.5f, 72.5f, 85};
  return direction(radians_from(kCenters[ring]), radians_from(45.0f * static_cast<float>(place)));
}

uint32_t patch(int ring, int place) { return ring == 0 ? 0 : static_cast<uint32_t>(1 + 8 * (ring - 1) + place); }

/// Distinct at every pair.
double mixed(uint32_t light, uint32_t view) { return 0.001 * (light + 1) + 0.1 * (view % 7); }

TEST(WindowBsdf, GivesItsMatrixAtTheCentersOfPatches) {
  test::record_input("BSDF XML of Radiance and WINDOW", "matrices: Klems's bases and own ones, by columns and rows",
                     "read");
  for (const bool rows : {false, true}) {
    const auto measurement = load_measurement(written(document(block_of({}, mixed, rows), rows ? "Rows" : "Columns")));
    EXPECT_EQ(measurement->provenance().format, "window-bsdf");
    EXPECT_EQ(measurement->provenance().description, "Linen");
    EXPECT_EQ(measurement->counts().valid, uint64_t{kPatches} * kPatches);
    for (const int ring : {0, 1, 3, 6}) {
      for (const int place : {0, 3, 6}) {
        // Light that arrives from the other side of the normal is numbered by where it goes.
        const Vec3 wl = center(ring, (place + 4) % 8), wv = center(4, 5);
        const double expected = mixed(patch(ring, place), patch(4, 5));
        EXPECT_NEAR(value_of(*measurement, wv, wl).g, expected, 1e-5) << ring << ' ' << place << ' ' << rows;
      }
    }
  }
}

/// A mirror: what light and view share a patch for.
TEST(WindowBsdf, MirrorImagesShareANumber) {
  const Value mirror = [](uint32_t light, uint32_t view) { return light == view ? 1.0 : 0.0; };
  const auto measurement = load_measurement(written(document(block_of({}, mirror, false))));
  for (const int place : {0, 1, 5}) {
    const Vec3 wl = center(3, place), reflected(-wl.x, -wl.y, wl.z);
    EXPECT_NEAR(value_of(*measurement, reflected, wl).g, 1, 1e-4f);
    EXPECT_NEAR(value_of(*measurement, wl, wl).g, 0, 1e-4f);
  }
}

TEST(WindowBsdf, IsLinearBetweenPatchesAndConstantWhereTheyAreAlike) {
  const auto constant = load_measurement(written(document(block_of(
      {}, [](auto, auto) { return 0.25; }, false))));
  const auto ringed = load_measurement(written(document(block_of(
      {}, [](uint32_t light, uint32_t) { return light == 0 ? 0.0 : 1.0 + (light - 1) / 8; }, false))));
  for (const Vec3& wl : hemisphere_fibonacci(40)) {
    EXPECT_NEAR(value_of(*constant, direction(0.4f, 2), wl).r, 0.25f, 1e-5f);
  }
  EXPECT_NEAR(value_of(*ringed, {0, 0, 1}, direction(radians_from(20.0f), 1)).g, 1.5f, 1e-4f);
  EXPECT_NEAR(value_of(*ringed, {0, 0, 1}, direction(radians_from(89.0f), 1)).g, 6, 1e-4f);
}

TEST(WindowBsdf, KlemsBasesAreKnownByName) {
  for (const auto& [name, patches] :
       {std::pair("LBNL/Klems Full", 145u), std::pair("LBNL/Klems Half", 73u), std::pair("LBNL/Klems Quarter", 41u)}) {
    const Block block{.basis = name, .patches = patches};
    const auto measurement = load_measurement(written(document(block_of(block, mixed, false))));
    EXPECT_EQ(measurement->counts().valid, uint64_t{patches} * patches) << name;
    for (const Vec3& w : hemisphere_fibonacci(50)) {
      float sum = 0;
      for (const auto& near : KlemsBasis::standard(name)->around(w)) {
        sum += near.weight;
        EXPECT_LT(near.patch, patches);
      }
      EXPECT_NEAR(sum, 1, 1e-5f);
    }
  }
}

/// X = Y = Z is white whatever the file's illuminant was; X alone is a red that Rec. 709 does not hold.
TEST(WindowBsdf, ColorsAreThoseOfXAndZ) {
  test::record_input("BSDF XML of Radiance and WINDOW", "CIE-X and CIE-Z beside Visible", "read as colors");
  const auto of = [](double x, double y, double z) {
    std::string blocks;
    for (const auto& [name, value] : {std::pair("CIE-X", x), std::pair("Visible", y), std::pair("CIE-Z", z)}) {
      blocks += block_of(
          {.wavelength = name}, [value](auto, auto) { return value; }, false);
    }
    return value_of(*load_measurement(written(document(blocks))), {0, 0, 1}, {0, 0, 1});
  };
  const Rgb white = of(0.2, 0.2, 0.2), yellow = of(0.2, 0.2, 0.1);
  EXPECT_LT(glm::distance(white, Rgb(0.2f)), 1e-4f);
  EXPECT_LT(yellow.b, 0.15f);
  EXPECT_GT(yellow.r, yellow.b);
}

TEST(WindowBsdf, TheFrontIsTakenBeforeTheBack) {
  const auto constant = [](double value) { return [value](uint32_t, uint32_t) { return value; }; };
  const std::string back = block_of({.direction = "Reflection Back"}, constant(0.3), false);
  const std::string front = block_of({}, constant(0.1), false);
  EXPECT_NEAR(value_of(*load_measurement(written(document(back + front))), {0, 0, 1}, {0, 0, 1}).g, 0.1f, 1e-5f);
  EXPECT_NEAR(value_of(*load_measurement(written(document(back))), {0, 0, 1}, {0, 0, 1}).g, 0.3f, 1e-5f);
}

TEST(WindowBsdf, NegativeEntriesAreLeftOut) {
  const Value some = [](uint32_t light, uint32_t view) { return light == 9 && view == 9 ? -1.0 : 0.5; };
  const auto measurement = load_measurement(written(document(block_of({}, some, false))));
  EXPECT_EQ(measurement->counts().negative, 1u);
  EXPECT_NEAR(value_of(*measurement, center(2, 1), center(2, 4)).g, 0.5f, 1e-5f);
}

/// A node of 2^level cells a side whose values are `value` of its cells' lower corners: as branches above `grid_level`.
std::string tree_text(int dimensions, int level, int grid_level,
                      const std::function<double(std::span<const double>)>& value, std::vector<double> corner = {},
                      double width = 1) {
  corner.resize(static_cast<size_t>(dimensions));
  std::string text = "{";
  if (level > grid_level) {
    for (int branch = 0; branch < 1 << dimensions; ++branch) {
      std::vector<double> lower = corner;
      for (int i = 0; i < dimensions; ++i) lower[static_cast<size_t>(i)] += (branch >> i & 1) * width / 2;
      text += tree_text(dimensions, level - 1, grid_level, value, lower, width / 2) + "\n";
    }
  } else {
    const int cells = 1 << level;
    for (int cell = 0; cell < 1 << level * dimensions; ++cell) {
      std::vector<double> lower = corner;
      for (int i = 0; i < dimensions; ++i) {  // the last dimension goes fastest
        lower[static_cast<size_t>(i)] += (cell >> level * (dimensions - 1 - i)) % cells * width / cells;
      }
      text += std::to_string(value(lower)) + (cell % 2 ? " " : ", ");
    }
  }
  return text + "}";
}

/// [SC97], by sectors of azimuth as in the paper.
Vec2 paper_square(double x, double y) {
  const double r = std::hypot(x, y), quarter = kPi / 4;
  double phi = std::atan2(y, x);
  if (phi < -quarter) phi += 2 * kPi;
  double a = 0, b = 0;
  if (phi < quarter) {
    a = r, b = phi * a / quarter;
  } else if (phi < 3 * quarter) {
    b = r, a = -(phi - 2 * quarter) * b / quarter;
  } else if (phi < 5 * quarter) {
    a = -r, b = (phi - 4 * quarter) * a / quarter;
  } else {
    b = -r, a = -(phi - 6 * quarter) * b / quarter;
  }
  return {static_cast<float>((a + 1) / 2), static_cast<float>((b + 1) / 2)};
}

/// The cell's lower corner at a place, in cells of 1/8.
double corner_of(float place) { return std::floor(place * 8.0f) / 8; }
bool near_an_edge(float place) { return std::abs(place * 8 - std::round(place * 8)) < 1e-3f; }

TEST(WindowBsdf, TreesOfFourDimensionsAreReadAtTheSquaresOfLightAndViewer) {
  test::record_input("BSDF XML of Radiance and WINDOW", "tensor trees of three and four dimensions", "read");
  const auto number = [](std::span<const double> c) { return 0.1 + c[0] + 0.3 * c[1] + 0.05 * c[2] + 0.01 * c[3]; };
  for (const int grid_level : {0, 1, 3}) {
    const auto measurement = load_measurement(written(tree_document(tree_text(4, 3, grid_level, number), 4)));
    EXPECT_EQ(measurement->counts().valid, 4096u);
    EXPECT_FALSE(measurement->isotropic());
    int compared = 0;
    for (const Vec3& wv : hemisphere_fibonacci(23)) {
      for (const Vec3& wl : hemisphere_fibonacci(31)) {
        const Vec2 light = paper_square(-wl.x, -wl.y), viewer = paper_square(wv.x, wv.y);
        const float all[] = {light.x, light.y, viewer.x, viewer.y};
        if (std::ranges::any_of(all, near_an_edge)) continue;
        const double corner[] = {corner_of(light.x), corner_of(light.y), corner_of(viewer.x), corner_of(viewer.y)};
        EXPECT_NEAR(value_of(*measurement, wv, wl).g, number(corner), 2e-6) << grid_level;
        ++compared;
      }
    }
    EXPECT_GT(compared, 500);
  }
}

TEST(WindowBsdf, TreesOfThreeDimensionsTurnTheViewerWithTheLight) {
  const auto number = [](std::span<const double> c) { return 0.1 + c[0] + 0.3 * c[1] + 0.05 * c[2]; };
  const auto measurement = load_measurement(written(tree_document(tree_text(3, 3, 1, number), 3)));
  EXPECT_TRUE(measurement->isotropic());
  int compared = 0;
  for (const Vec3& wv : hemisphere_fibonacci(23)) {
    for (const Vec3& wl : hemisphere_fibonacci(31)) {
      const double sine = std::hypot(wl.x, wl.y), turn = std::atan2(-wl.y, -wl.x);
      const double x = std::cos(turn) * wv.x + std::sin(turn) * wv.y, y = std::cos(turn) * wv.y - std::sin(turn) * wv.x;
      const Vec2 viewer = paper_square(x, y);
      const float angle = static_cast<float>(0.5 - 0.5 * sine);
      const float all[] = {angle, viewer.x, viewer.y};
      if (std::ranges::any_of(all, near_an_edge)) continue;
      const double corner[] = {corner_of(angle), corner_of(viewer.x), corner_of(viewer.y)};
      EXPECT_NEAR(value_of(*measurement, wv, wl).g, number(corner), 2e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
  // At the normal the first coordinate is just below a half.
  EXPECT_NEAR(value_of(*measurement, {0.1f, 0.2f, 0.97f}, {0, 0, 1}).g, 0.1 + 3.0 / 8 + 0.3 * 0.5 + 0.05 * 0.5, 0.05);
}

/// u' and v' have trees of their own shape.
TEST(WindowBsdf, ColorsOfTreesAreThoseOfTheirChromaticities) {
  const double x = 0.3, y = 0.4, divisor = -2 * x + 12 * y + 3;
  const std::string basis = "LBNL/Shirley-Chiu", u = "{" + std::to_string(4 * x / divisor) + "}",
                    v = tree_text(3, 1, 0, [&](auto) { return 9 * y / divisor; });
  const std::string blocks =
      tree_block("{0.2}", "Visible", basis) + tree_block(u, "CIE-u", basis) + tree_block(v, "CIE-v", basis);
  const Rgb found = value_of(*load_measurement(written(document(blocks, "TensorTree3"))), {0, 0, 1}, {0, 0, 1});
  const Rgb expected = rec709_of_xyz(0.2 * Vec3d(x / y, 1, (1 - x - y) / y));
  EXPECT_LT(glm::distance(found, expected), 1e-5f);
}

std::string replaced(std::string text, const std::string& words, const std::string& instead) {
  for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + instead.size()))
    text.replace(at, words.size(), instead);
  return text;
}

TEST(WindowBsdf, CommentsBeforeTheRootHaveAnyLength) {
  test::record_input("BSDF XML of Radiance and WINDOW", "long comments before the root, UTF-8 mark, UTF-16", "read");
  const std::string good = tree_document("{0.25}", 3);
  const std::string license = "<!--" + std::string(200000, ' ') + "-->\n<!-- <materialx> -->";
  std::string utf16 = "\xff\xfe";
  for (const char c : replaced(good, "UTF-8", "UTF-16")) utf16 += std::string{c, '\0'};
  for (const std::string& text :
       {replaced(good, "<WindowElement>", license + "<WindowElement>"), "\xef\xbb\xbf" + good, utf16}) {
    const std::string path = written(text);
    EXPECT_TRUE(is_measurement_file(path));
    EXPECT_NEAR(value_of(*load_measurement(path), {0, 0, 1}, {0, 0, 1}).g, 0.25, 1e-6);
  }
}

/// With a detector whose name cites a standard, as WINDOW writes it.
TEST(WindowBsdf, NamesMayHaveAPrefix) {
  test::record_input("BSDF XML of Radiance and WINDOW", "a namespace prefix at all elements or at the root", "read");
  const std::string good = replaced(tree_document("{0.25}", 3), "<WavelengthDataBlock>",
                                    "<DetectorSpectrum>ASTM E308 1931 Y.dsp</DetectorSpectrum><WavelengthDataBlock>");
  const std::string root = replaced(replaced(good, "<Window", "<w:Window"), "</Window", "</w:Window");
  std::string all;
  for (size_t i = 0; i < good.size(); ++i) {
    all += good[i];
    if (good[i] == '<' && good[i + 1] == '/') all += good[++i];
    if ((good[i] == '<' || good[i] == '/') && std::isalpha(static_cast<unsigned char>(good[i + 1])) &&
        (good[i] == '<' || good[i - 1] == '<'))
      all += "wbsdf:";
  }
  for (const std::string& text : {root, all}) {
    EXPECT_NEAR(value_of(*load_measurement(written(text)), {0, 0, 1}, {0, 0, 1}).g, 0.25, 1e-6) << text;
  }
  const std::string other = "<w:WindowElement><Other>ASTM E308</Other></w:WindowElement>";
  EXPECT_NE(test::refusal([&] { load_measurement(written(other)); }).find("not a BSDF file"), std::string::npos);
}

TEST(WindowBsdf, NumbersMayHaveAPlusSign) {
  test::record_input("BSDF XML of Radiance and WINDOW", "numbers with a plus sign", "read");
  const auto tree = load_measurement(written(tree_document("{+2.5e-01}", 3)));
  EXPECT_NEAR(value_of(*tree, {0, 0, 1}, {0, 0, 1}).g, 0.25, 1e-6);
  const std::string good = document(block_of({}, mixed, false));
  const auto matrix = load_measurement(written(replaced(good, "\t0.", "\t+0.")));
  EXPECT_EQ(matrix->counts().valid, load_measurement(written(good))->counts().valid);
  const auto bounds = load_measurement(written(replaced(good, "<UpperTheta>", "<UpperTheta>+")));
  EXPECT_EQ(bounds->counts().valid, uint64_t{kPatches} * kPatches);
}

TEST(WindowBsdf, NumbersBeyondAFloatAreZeroOrNotFinite) {
  test::record_input("BSDF XML of Radiance and WINDOW", "values too large or too small", "not finite, counted; 0");
  const auto measurement =
      load_measurement(written(tree_document("{1e-60 0." + std::string(400, '0') + "1 1e60 1e400 -1 1 1 1}", 3)));
  EXPECT_EQ(measurement->counts().not_finite, 2u);
  EXPECT_EQ(measurement->counts().negative, 1u);
  EXPECT_EQ(measurement->counts().valid, 5u);
}

TEST(WindowBsdf, WhatCannotBeReadIsNamed) {
  test::record_input("BSDF XML of Radiance and WINDOW", "transmission alone, damaged files", "refused with a sentence");
  const std::string good = document(block_of({}, mixed, false));
  const auto without = [&](const std::string& words, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(words), words.size(), instead);
    return text;
  };
  const std::pair<std::string, const char*> files[] = {
      {tree_document("{1", 4), "lacks '}'"},
      {tree_document("{1}}", 4), "continues after the last brace of the tree at '}'"},
      {tree_document("{1 2}", 4), "a cell of 2 values instead of 1, 16, 256"},
      {tree_document("{}", 3), "a cell of 0 values"},
      {tree_document("{{1}{2}}", 3), "lacks '{' at '}'"},
      {tree_document("{1 x}", 3), "lacks '}' at 'x}'"},
      {tree_document("", 3), "lacks '{' at the end of the data"},
      {tree_document(std::string(1000, '{'), 3), "deeper than 16 levels"},
      {tree_document("{1}", 3, "Own"), "AngleBasis 'Own'"},
      {document("", "Spirals"), "IncidentDataStructure is 'Spirals'"},
      {without("Reflection Front", "Transmission Front"), "no reflection"},
      {without("<ColumnAngleBasis>Own", "<ColumnAngleBasis>Other"), "'Other' is neither defined"},
      {without("<ColumnAngleBasis>Own", "<ColumnAngleBasis>LBNL/Klems Half"), "its angle bases require 3577"},
      {without("<nPhis>8", "<nPhis>4294967295"), "at most 4096 patches"},
      {without("<UpperTheta>20", "<UpperTheta>2"), "rings must follow each other"},
      {without("<UpperTheta>90", "<UpperTheta>88"), "ends at 88"},
      {without("</ScatteringData>", "x</ScatteringData>"),
       "ScatteringData of Reflection Front, Visible, has 'x' where value 2402 is expected"},
      {without("<ScatteringData>", "<ScatteringData>0.1x "), "has '0.1x"},
      {without("<UpperTheta>5", "<UpperTheta>5,"), "spans '0.000000' to '5,.000000' degrees with '1' patches"},
      {without("</ScatteringData>", ""), "not a valid XML"},
      {without("Optical>", "Optics>"), "no"}};
  for (const auto& [text, words] : files) {
    const std::string said = test::refusal([&, &file = text] { load_measurement(written(file)); });
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_NE(said.find("linen.xml"), std::string::npos) << said;
  }
  for (size_t size = 0; size < good.size(); size += 997) {
    EXPECT_NE(test::refusal([&] { load_measurement(written(good.substr(0, size))); }), "") << size;
  }
}

}  // namespace
}  // namespace velour::window_bsdf_test
