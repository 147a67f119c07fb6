#include "btf/formats/btf_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "btf_support.h"
#include "image/picture.h"
#include "support/test_data.h"

namespace velour::btf_folder_test {
namespace {

using test::message_of;

TEST(BtfFolder, GivesBackEveryBit) {
  const std::string path = test::scratch_folder() / "tile";
  const test::RandomBtf btf(test::small_index(), 1);
  btf.write(path);
  const auto read = load_btf_folder(path);
  EXPECT_EQ(read->layout(), btf.index.layout);
  EXPECT_EQ(read->grid(), btf.index.grid);
  EXPECT_EQ(read->shell()->thickness, btf.index.shell->thickness);
  EXPECT_EQ(read->shell()->reference_height, btf.index.shell->reference_height);
  EXPECT_EQ(test::all_pairs(*read), btf.values);
  std::vector<HalfBits> errors(btf.errors.size());
  ASSERT_TRUE(read->read_errors(0, read->layout().pairs(), errors));
  EXPECT_EQ(errors, btf.errors);
  for (uint32_t v = 0; v < btf.structure.size(); ++v) {
    const ViewStructure structure = read->read_structure(v).value();
    EXPECT_EQ(structure.coverage, btf.structure[v].coverage);
    EXPECT_EQ(structure.height_mean, btf.structure[v].height_mean);
    EXPECT_EQ(structure.height_spread, btf.structure[v].height_spread);
  }
}

// A file of one part is laid out in another way than one of several.
TEST(BtfFolder, NeedsNeitherErrorsNorStructureNorSize) {
  const std::string path = test::scratch_folder() / "tile";
  BtfIndex index{PairLayout(ring_directions(30, 2), ring_directions(45, 3)), {4, 2}};
  const test::RandomBtf btf(index, 9);
  btf.write(path);
  const auto read = load_btf_folder(path);
  EXPECT_EQ(test::all_pairs(*read), btf.values);
  EXPECT_FALSE(read->grid().tile_metres || read->shell() || read->read_structure(0));
  EXPECT_FALSE(read->read_errors(0, 0, {}));
  EXPECT_TRUE(read->layout().complete());
}

TEST(BtfFolder, ReadsAnyRangeOfPairs) {
  const std::string path = test::scratch_folder() / "tile";
  const test::RandomBtf btf(test::small_index(), 2);
  btf.write(path);
  const auto read = load_btf_folder(path);
  const uint64_t image = btf.index.grid.texels() * 3, pairs = read->layout().pairs();
  for (uint64_t first = 0; first < pairs; ++first) {
    for (uint64_t count = 0; count <= pairs - first; ++count) {
      std::vector<HalfBits> some(count * image);
      read->read_pairs(first, count, some);
      EXPECT_TRUE(std::equal(some.begin(), some.end(), btf.values.begin() + static_cast<ptrdiff_t>(first * image)));
    }
  }
  std::vector<HalfBits> none;
  EXPECT_THROW(read->read_pairs(pairs, 1, none), Error);
  EXPECT_THROW(read->read_pairs(pairs + 1, 0, none), Error);
}

// Other programs read the same pictures: upright, one light below the other.
TEST(BtfFolder, ViewsAreOpenExrFilesThatShowThePicturesUpright) {
  const std::string path = test::scratch_folder() / "tile";
  test::RandomBtf btf(test::small_index(), 3);
  for (HalfBits& h : btf.values) h = static_cast<HalfBits>(h & 0x3fff);  // finite, so that floats can be compared
  btf.write(path);
  const Picture picture = read_picture(view_path(path, 0));
  const uint64_t width = btf.index.grid.width, height = btf.index.grid.height, lights = btf.index.layout.first(1);
  ASSERT_EQ(static_cast<uint64_t>(picture.width), width);
  ASSERT_EQ(static_cast<uint64_t>(picture.height), height * lights);
  ASSERT_EQ(picture.channels, 3);
  std::vector<float> values(btf.values.size());
  halves_to_floats(btf.values, values);
  for (uint64_t light = 0; light < lights; ++light) {
    for (uint64_t y = 0; y < height; ++y) {
      // A Picture has its row 0 at the bottom: the first light is the topmost image.
      const float* row = picture.pixel(0, static_cast<int>((lights - 1 - light) * height + y));
      const float* expected = values.data() + (light * height + y) * width * 3;
      EXPECT_TRUE(std::equal(row, row + 3 * width, expected)) << light << ' ' << y;
    }
  }
}

TEST(BtfFolder, CountsWhatIsNoValueAndReadsItAsItIs) {
  const std::string path = test::scratch_folder() / "tile";
  test::RandomBtf btf(test::small_index(), 4);
  std::fill(btf.values.begin(), btf.values.end(), HalfBits{0x3c00});
  btf.values[1] = 0x7e00;      // NaN
  btf.values[2] = 0x7c00;      // infinite
  btf.values[3] = 0xbc00;      // -1
  btf.values[4] = 0x8000;      // -0
  btf.values.back() = 0xfc00;  // -infinite
  btf.write(path);
  const auto read = load_btf_folder(path);
  EXPECT_EQ(read->all_counts(), (ValueCounts{btf.values.size(), 3, 1}));
  EXPECT_EQ(test::all_pairs(*read), btf.values);
}

TEST(BtfFolder, TheHashNamesTheContent) {
  const auto folder = test::scratch_folder();
  test::RandomBtf btf(test::small_index(), 5);
  btf.write(folder / "a");
  btf.write(folder / "b");
  btf.values[7] ^= 1;
  btf.write(folder / "c");
  const std::string hash = load_btf_folder(folder / "a")->provenance().sha256;
  EXPECT_EQ(load_btf_folder(folder / "b")->provenance().sha256, hash);
  EXPECT_NE(load_btf_folder(folder / "c")->provenance().sha256, hash);
}

TEST(BtfFolder, AKilledCaptureGoesOnWithItsWholeViews) {
  const std::string path = test::scratch_folder() / "tile";
  const test::RandomBtf btf(test::small_index(), 6);
  {
    const BtfFolderWriter writer(path, btf.index, false);
    btf.write_view(writer, 1);
    EXPECT_EQ(message_of([&] { writer.finish(); }),
              path + ": view 0 is missing or damaged; write it before the index.");
  }
  EXPECT_NE(message_of([&] { load_btf_folder(path); }).find("is incomplete"), std::string::npos);
  EXPECT_NE(message_of([&] { BtfFolderWriter(path, btf.index, false); }).find("resume the capture"), std::string::npos);
  const BtfFolderWriter writer(path, btf.index, true);
  EXPECT_FALSE(writer.has(0));
  EXPECT_TRUE(writer.has(1));
  std::filesystem::resize_file(view_path(path, 1), std::filesystem::file_size(view_path(path, 1)) - 1);
  EXPECT_FALSE(writer.has(1));
  for (uint32_t v = 0; v < btf.index.layout.views().size(); ++v) btf.write_view(writer, v);
  writer.finish();
  EXPECT_EQ(test::all_pairs(*load_btf_folder(path)), btf.values);
  uint64_t bytes = 0;
  for (const auto& file : std::filesystem::directory_iterator(path)) bytes += file.file_size();
  EXPECT_EQ(writer.bytes(), bytes);
}

TEST(BtfFolder, AnotherBtfIsNotResumed) {
  const std::string path = test::scratch_folder() / "tile";
  const BtfIndex index = test::small_index();
  const BtfFolderWriter first(path, index, false);
  const auto refusal = [&](const BtfIndex& other) { return message_of([&] { BtfFolderWriter(path, other, true); }); };
  EXPECT_EQ(refusal(index), "");
  BtfIndex other = index;
  other.options = R"({"seed": 3, "samples": 16})";  // the same in another order
  EXPECT_EQ(refusal(other), "");
  other.options = R"({"samples": 16, "seed": 4})";
  EXPECT_NE(refusal(other).find("different 'options'"), std::string::npos);
  other = index;
  other.grid.tile_metres = std::nullopt;
  EXPECT_NE(refusal(other).find("different 'tile_metres'"), std::string::npos);
  other = index;
  other.layout = PairLayout(index.layout.views(), index.layout.lights());
  EXPECT_NE(refusal(other).find("different 'pairs'"), std::string::npos);
  other = index;
  other.shell->thickness = std::nextafter(other.shell->thickness, 1.0);
  EXPECT_NE(refusal(other).find("different 'shell'"), std::string::npos);
}

TEST(BtfFolder, AFolderOfOtherFilesIsLeftAlone) {
  const auto folder = test::scratch_folder();
  std::ofstream(folder / "thesis.tex") << "text";
  EXPECT_NE(message_of([&] { BtfFolderWriter(folder, test::small_index(), true); }).find("do not belong to a BTF"),
            std::string::npos);
  EXPECT_FALSE(is_btf_folder(folder));
}

TEST(BtfFolder, RefusesViewsOfOtherSizes) {
  const std::string path = test::scratch_folder() / "tile";
  const test::RandomBtf btf(test::small_index(), 7);
  const BtfFolderWriter writer(path, btf.index, false);
  BtfView view = btf.view(0);
  view.values = view.values.first(view.values.size() - 1);
  EXPECT_NE(message_of([&] { writer.write(0, view); }).find("part 'values'"), std::string::npos);
  view = btf.view(0);
  view.errors = {};
  EXPECT_NE(message_of([&] { writer.write(0, view); }).find("part 'errors'"), std::string::npos);
  view = btf.view(0);
  view.structure = nullptr;
  EXPECT_THROW(writer.write(0, view), Error);
  EXPECT_THROW(writer.write(99, btf.view(0)), Error);
}

TEST(BtfFolder, AMissingOrForeignViewIsNamed) {
  const auto folder = test::scratch_folder();
  const test::RandomBtf btf(test::small_index(), 8);
  btf.write(folder / "a");
  const std::string view = view_path(folder / "a", 1);
  std::filesystem::copy_file(view, folder / "kept.exr");
  std::filesystem::copy_file(view_path(folder / "a", 0), view, std::filesystem::copy_options::overwrite_existing);
  EXPECT_NE(message_of([&] { load_btf_folder(folder / "a"); }).find("view_0001.exr: its parts do not match"),
            std::string::npos);
  std::filesystem::remove(view);
  EXPECT_NE(message_of([&] { load_btf_folder(folder / "a"); }).find("view_0001.exr: cannot read"), std::string::npos);
  std::filesystem::copy_file(folder / "kept.exr", view);
  const auto read = load_btf_folder(folder / "a");
  std::filesystem::resize_file(view, 5000);  // after it was loaded
  std::vector<HalfBits> values(btf.values.size());
  EXPECT_NE(message_of([&] { read->read_pairs(0, read->layout().pairs(), values); }).find("truncated or damaged"),
            std::string::npos);
}

}  // namespace
}  // namespace velour::btf_folder_test
