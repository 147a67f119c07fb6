#include "btf/formats/btf_export.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "btf/formats/load_btf.h"
#include "btf_support.h"
#include "support/inputs.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::btf_export_test {
namespace {

namespace fs = std::filesystem;
using test::message_of;

/// NaNs come back as NaNs, but not with all their bits.
std::vector<HalfBits> with_one_nan(std::vector<HalfBits> values) {
  for (HalfBits& h : values)
    if ((h & 0x7fff) > 0x7c00) h = 0x7e00;
  return values;
}

struct Trip {
  std::shared_ptr<const BtfMeasurement> original, read;
  BtfExportReport report;
};

Trip trip(BtfIndex index, uint64_t seed) {
  const auto folder = test::scratch_folder();
  test::RandomBtf(std::move(index), seed).write(folder / "tile");
  Progress progress;
  Trip t{load_btf(folder / "tile"), nullptr, {}};
  t.report = export_btf(*t.original, folder / "pictures", progress);
  EXPECT_EQ(progress.fraction(), 1);
  t.read = load_btf(folder / "pictures");
  return t;
}

void expect_same(const Trip& t) {
  EXPECT_EQ(t.read->layout(), t.original->layout());
  EXPECT_EQ(t.read->grid(), t.original->grid());
  EXPECT_EQ(with_one_nan(test::all_pairs(*t.read)), with_one_nan(test::all_pairs(*t.original)));
}

TEST(BtfExport, WholeDegreesBecomeNamesAndComeBackBitForBit) {
  // An order that is not the one of the angles.
  const BtfIndex index{PairLayout({{60, 240}, {0, 0}, {15, 180}}, {{75, 345}, {15, 0}, {120, 15}, {30, 90}}),
                       {4, 3, Vec2(0.1f, 0.3f)}};
  const Trip t = trip(index, 1);
  expect_same(t);
  EXPECT_EQ(t.report.format, "ubo2003");
  EXPECT_EQ(t.report.pictures, 12u);
  EXPECT_TRUE(fs::exists(t.read->provenance().path + "/00004 tl015 pl000 tv000 pv000.exr"));
}

TEST(BtfExport, OtherAnglesAreListedAndComeBackBitForBit) {
  const Trip t = trip({PairLayout(even_directions(5), even_directions(4)), {3, 3}}, 2);
  expect_same(t);
  EXPECT_EQ(t.report.format, "csv");
  uint64_t bytes = 0;
  for (const auto& file : fs::directory_iterator(t.read->provenance().path.ends_with(".csv")
                                                     ? fs::path(t.read->provenance().path).parent_path()
                                                     : fs::path(t.read->provenance().path)))
    bytes += file.file_size();
  EXPECT_EQ(t.report.bytes, bytes);
}

TEST(BtfExport, PicturesOutsideTheFolderOfTheirIndexAreToldOf) {
  const Trip t = trip({PairLayout(even_directions(5), even_directions(4)), {3, 3}}, 2);
  EXPECT_TRUE(t.read->warnings().empty());
  const fs::path folder = fs::path(t.read->provenance().path).parent_path(),
                 elsewhere = folder.parent_path() / "elsewhere";
  fs::create_directories(elsewhere);
  std::ifstream index(folder / "btf.csv");
  std::ofstream moved(elsewhere / "btf.csv");
  for (std::string line; std::getline(index, line);) {
    const bool is_picture = !line.starts_with('#') && !line.starts_with("file");
    moved << (is_picture ? "../pictures/" : "") << line << '\n';
  }
  moved.close();
  const auto read = load_btf(elsewhere);
  ASSERT_EQ(read->warnings().size(), 1u);
  const Warning told = read->warnings()[0];
  EXPECT_EQ(told.code, WarningCode::images_outside_folder);
  EXPECT_EQ(test::value_of<uint64_t>(told, "outside"), 20u);
  EXPECT_EQ(test::value_of<uint64_t>(told, "images"), 20u);
  EXPECT_NE(test::value_of<std::string>(told, "first").find("pictures"), std::string::npos);
  test::record_input("CSV index of a BTF", "pictures outside its folder", "read, with a warning");
}

TEST(BtfExport, IncompleteSetsKeepTheirOrder) {
  const Trip t = trip({PairLayout({{0, 0}, {10, 0}}, {{0, 0}, {20, 0}, {30, 0}}, {{0, 2}, {0, 1, 2}}), {2, 2}}, 3);
  expect_same(t);
  EXPECT_EQ(t.report.format, "csv");
}

TEST(BtfExport, AFolderThatHoldsSomethingIsLeftAlone) {
  const auto folder = test::scratch_folder();
  test::RandomBtf({PairLayout({{0, 0}}, {{0, 0}}), {1, 1}}, 4).write(folder / "tile");
  Progress progress;
  EXPECT_NE(message_of([&] { export_btf(*load_btf(folder / "tile"), folder / "tile", progress); }).find("is not empty"),
            std::string::npos);
  progress.cancel();
  EXPECT_EQ(message_of([&] { export_btf(*load_btf(folder / "tile"), folder / "new", progress); }), "Cancelled.");
}

}  // namespace
}  // namespace velour::btf_export_test
