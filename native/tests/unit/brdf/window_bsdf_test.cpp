// BSDF XML files of Radiance and WINDOW, made here.
#include "brdf/window_bsdf.h"

#include <gtest/gtest.h>

#include <functional>

#include "brdf/klems_basis.h"
#include "file/file.h"
#include "measurement_support.h"
#include "sphere/directions.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour {
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

std::string written(const std::string& text) {
  const std::string path = test::scratch_folder() / "linen.xml";
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

/// The centre of a patch: ring 1 to 6 (0 is the cap), eight azimuths.
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
TEST(WindowBsdf, ColoursAreThoseOfXAndZ) {
  test::record_input("BSDF XML of Radiance and WINDOW", "CIE-X and CIE-Z beside Visible", "read as colours");
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

TEST(WindowBsdf, WhatCannotBeReadIsNamed) {
  test::record_input("BSDF XML of Radiance and WINDOW", "tensor trees, transmission alone, damaged files",
                     "refused with a sentence");
  const std::string good = document(block_of({}, mixed, false));
  const auto without = [&](const std::string& words, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(words), words.size(), instead);
    return text;
  };
  const std::pair<std::string, const char*> files[] = {
      {document("", "TensorTree4"), "bsdf2klems"},
      {document("", "Spirals"), "IncidentDataStructure 'Spirals'"},
      {without("Reflection Front", "Transmission Front"), "no reflection"},
      {without("<ColumnAngleBasis>Own", "<ColumnAngleBasis>Other"), "'Other' is not defined"},
      {without("<ColumnAngleBasis>Own", "<ColumnAngleBasis>LBNL/Klems Half"), "its angle bases make 3577"},
      {without("<nPhis>8", "<nPhis>4294967295"), "4096 patches at most"},
      {without("<UpperTheta>20", "<UpperTheta>2"), "rings follow each other"},
      {without("<UpperTheta>90", "<UpperTheta>88"), "ends at 88"},
      {without("</ScatteringData>", "x</ScatteringData>"), "has 'x' where a number is due"},
      {without("</ScatteringData>", ""), "no whole XML"},
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
}  // namespace velour
