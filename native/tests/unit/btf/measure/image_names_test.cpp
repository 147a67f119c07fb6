#include "btf/formats/picture_index.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "btf/formats/image_set.h"
#include "btf_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::image_names_test {
namespace {

using test::message_of;

void touch(const std::filesystem::path& file) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "x";
}

TEST(ImageNames, AreReadAsPeopleWriteThem) {
  const NamedAngles expected{{15, 0}, {30, 120}, 84};
  for (const char* name :
       {"00084 tl015 pl000 tv030 pv120", "00084_tl015_pl000_tv030_pv120", "84 TL15 PL0 TV30 PV120",
        "WoolPKNT256_00084_tl015_pl000_tv030_pv120", "00084-tl015pl000tv030pv120", "00084 tv030 pv120 tl015 pl000",
        "84 tl_15 pl_0 tv_30 pv_120", "84 tl=15 pl=0 tv=30 pv=120"}) {
    const auto read = angles_of_name(name);
    ASSERT_TRUE(read) << name;
    EXPECT_EQ(read->light, expected.light) << name;
    EXPECT_EQ(read->view, expected.view) << name;
    EXPECT_EQ(read->index, expected.index) << name;
  }
  EXPECT_EQ(name_of_angles(expected), "00084 tl015 pl000 tv030 pv120");
}

TEST(ImageNames, MayLackAnIndexAndHaveFractions) {
  const auto read = angles_of_name("tl017.5 pl000 tv000 pv359.25");
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->index);
  EXPECT_EQ(read->light, (PolarAngles{17.5, 0}));
  EXPECT_EQ(read->view, (PolarAngles{0, 359.25}));
  EXPECT_FALSE(angles_of_name("wool256 tl015 pl000 tv000 pv000")->index);  // no number of its own
}

TEST(ImageNames, CommasBetweenDigitsAreAskedFor) {
  test::record_input("BTF images named by angles", "decimal commas", "refused with the name to choose");
  const auto folder = test::scratch_folder();
  touch(folder / "tl15,5 pl0 tv0 pv0.exr");
  EXPECT_EQ(message_of([&] { find_named_pictures(folder); }),
            (folder / "tl15,5 pl0 tv0 pv0.exr").string() +
                ": the file name has a comma between digits, which may be a decimal comma or separate two numbers. "
                "Rename the file, as 'tl15.5 pl0 tv0 pv0.exr' if the angle has a fraction.");
  EXPECT_FALSE(angles_of_name("tl0,pl0,tv0,pv0,00081"));
  EXPECT_EQ(angles_of_name("1,5 tl15,pl0,tv0,pv0")->light, (PolarAngles{15, 0})) << "control: other commas";
}

TEST(ImageNames, OthersAreNone) {
  for (const char* name : {"", "preview", "tl015 pl000 tv000", "tl pl tv pv", "tl015 tl016 pl000 tv000 pv000",
                           "atl015 pl000 tv000 pv000", "15 0 0 0", "tl0 pl0 tv0 pv99999999999999999999999"}) {
    EXPECT_FALSE(angles_of_name(name)) << name;
  }
}

TEST(ImageNames, FoldersInFoldersAndOtherFilesAreNoMatter) {
  const auto folder = test::scratch_folder();
  touch(folder / "tv000_pv000" / "00000 tl000 pl000 tv000 pv000.jpg");
  touch(folder / "tv000_pv000" / "00002 tl015 pl060 tv000 pv000.JPG");
  touch(folder / "tv015_pv000" / "00001 tl000 pl000 tv015 pv000.jpg");
  touch(folder / "tv015_pv000" / "00003 tl015 pl060 tv015 pv000.jpg");
  touch(folder / "readme.txt");
  touch(folder / ".hidden.jpg");
  const std::vector<PairPicture> found = find_named_pictures(folder);
  ASSERT_EQ(found.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found[i].light.theta, i < 2 ? 0 : 15) << i;
    EXPECT_EQ(found[i].view.theta, i % 2 ? 15 : 0) << i;
  }
}

TEST(ImageNames, WithoutIndicesTheOrderIsThatOfTheAngles) {
  const auto folder = test::scratch_folder();
  for (const char* view : {"tv060 pv000", "tv000 pv000"}) {
    for (const char* light : {"tl075 pl345", "tl015 pl060"}) touch(folder / (std::string(light) + " " + view + ".png"));
  }
  const std::vector<PairPicture> found = find_named_pictures(folder);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].view.theta, 0);
  EXPECT_EQ(found[0].light.theta, 15);
  EXPECT_EQ(found[3].view.theta, 60);
}

TEST(ImageNames, WhatIsWrongIsOneSentence) {
  const auto folder = test::scratch_folder();
  EXPECT_EQ(message_of([&] { find_named_pictures(folder); }),
            folder.string() +
                ": the folder contains neither images named by their angles, as in '00081 tl015 pl000 tv000 "
                "pv000.jpg', nor an index of images, btf.csv.");
  touch(folder / "00000 tl000 pl000 tv000 pv000.jpg");
  touch(folder / "00001 tl000 pl000 tv015 pv000.jpg");
  touch(folder / "00002 tl015 pl060 tv000 pv000.jpg");
  EXPECT_EQ(message_of([&] { find_named_pictures(folder); }),
            folder.string() +
                ": 1 of 4 images are missing, the first is 'tl015 pl060 tv015 pv000'. Copy the set again, or "
                "list the existing images in a CSV index, btf.csv.");
  touch(folder / "00004 tl015 pl060 tv000 pv000.jpg");
  EXPECT_NE(message_of([&] { find_named_pictures(folder); }).find("has the same angles as"), std::string::npos);
  touch(folder / "preview.jpg");
  EXPECT_NE(
      message_of([&] { find_named_pictures(folder); }).find("preview.jpg: the file name does not contain the angles"),
      std::string::npos);
}

/// The images need not exist: a fit would otherwise run before its model turned out to be too large.
TEST(ImageNames, TooManyDirectionsAreRefusedAtOnce) {
  const auto refusal = [](int views, int lights) {
    ImageSetSource source{"set.csv", "csv", {}};
    for (int i = 0; i < std::max(views, lights); ++i) {
      const PolarAngles view{0.01 * std::min(i, views - 1), 0}, light{0.01 * std::min(i, lights - 1), 0};
      source.pictures.push_back({"none.png", view, light, static_cast<uint64_t>(i), static_cast<uint64_t>(i)});
    }
    return test::message_of([&] { load_image_set(source, {}); });
  };
  const std::string end = " lights; at most 4096 of each are supported. Remove the images of the others.";
  EXPECT_EQ(refusal(4097, 1), "set.csv: has 4097 views and 1" + end);
  EXPECT_EQ(refusal(2, 4098), "set.csv: has 2 views and 4098" + end);
  EXPECT_EQ(refusal(4096, 4096).find("at most 4096"), std::string::npos);
}

}  // namespace
}  // namespace velour::image_names_test
