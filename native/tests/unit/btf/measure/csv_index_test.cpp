#include "btf/formats/picture_index.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/process.h"
#include "btf_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::csv_index_test {
namespace {

using test::message_of;

class CsvIndexTest : public ::testing::Test {
 protected:
  std::string written(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  std::string refusal(const std::string& text) const {
    const std::string message = message_of([&] { read_csv_index(written(text)); });
    return message.empty() ? "" : message.substr(path_.size());
  }
  std::string path_ = test::scratch_folder() / "set.csv";
};

TEST_F(CsvIndexTest, ReadsColumnsInAnyOrder) {
  const auto pictures = read_csv_index(
      written("\xef\xbb\xbf# my set\r\n\r\n phi_v, theta_v ,file,phi_l,theta_l,camera\r\n"
              "# first\r\n-30.5,0,\"a, \"\"b\"\".jpg\",1e1,45,left\r\n0,60,sub/c.png,0,0.125,right\r\n"));
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0].path, (std::filesystem::path(path_).parent_path() / "a, \"b\".jpg").string());
  EXPECT_EQ(pictures[0].view, (PolarAngles{0, -30.5}));
  EXPECT_EQ(pictures[0].light, (PolarAngles{45, 10}));
  EXPECT_EQ(pictures[1].path, (std::filesystem::path(path_).parent_path() / "sub/c.png").string());
  EXPECT_EQ(pictures[1].light, (PolarAngles{0.125, 0}));
  EXPECT_EQ(pictures[1].view_number, 1u);
  EXPECT_TRUE(is_csv_index(path_));
}

TEST_F(CsvIndexTest, LinesMayEndAsOnAnyMachine) {
  test::record_input("CSV index of a BTF", "UTF-8 mark; LF, CRLF, CR", "read");
  const std::string begin = "# first", head = "file,theta_l,phi_l,theta_v,phi_v";
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "\xef\xbb\xbf" + begin + end + head + end + end + "a.png,1,2,3,4" + end + "b.png,2,2,3,4";
    const auto pictures = read_csv_index(written(text));
    ASSERT_EQ(pictures.size(), 2u);
    EXPECT_EQ(pictures[0].view, (PolarAngles{3, 4}));
    EXPECT_TRUE(is_csv_index(path_));
    EXPECT_NE(refusal(text + end + "c.png,x,2,3,4" + end).find("line 6: 'theta_l' is 'x'"), std::string::npos);
  }
}

TEST_F(CsvIndexTest, IsKnownBehindCommentsOfAnyLength) {
  test::record_input("CSV index of a BTF", "comments of any length, no file extension", "read");
  std::string comment;
  for (int i = 0; i < 9000; ++i) comment += "# a line of the lab report\n";
  EXPECT_TRUE(is_csv_index(written(comment + "\n file , theta_l,phi_l,theta_v,phi_v\na.png,1,2,3,4\n")));
  EXPECT_EQ(read_csv_index(path_).size(), 1u);
  EXPECT_FALSE(is_csv_index(written(comment + "other,theta_l,phi_l,theta_v,phi_v\n")));
  EXPECT_FALSE(is_csv_index(written(comment)));
}

TEST_F(CsvIndexTest, NumbersMayHaveAPlusSign) {
  test::record_input("CSV index of a BTF", "numbers with a plus sign", "read");
  const auto pictures = read_csv_index(written("file,theta_l,phi_l,theta_v,phi_v\na.png,+15.5,-30,+1.5e1,1e-400\n"));
  EXPECT_EQ(pictures[0].light, (PolarAngles{15.5, -30}));
  EXPECT_EQ(pictures[0].view, (PolarAngles{15, 0}));
}

TEST_F(CsvIndexTest, NumbersSetTheOrder) {
  const auto pictures =
      read_csv_index(written("file,theta_l,phi_l,theta_v,phi_v,view,light\na.png,1,0,2,0,7,4\n/b.png,3,0,2,0,7,2"));
  EXPECT_EQ(pictures[0].view_number, 7u);
  EXPECT_EQ(pictures[1].light_number, 2u);
  EXPECT_EQ(pictures[1].path, "/b.png");
}

TEST_F(CsvIndexTest, RadiansAreAskedFor) {
  test::record_input("CSV index of a BTF", "angles in radians", "asked for (--angles)");
  const std::string text = "file,theta_l,phi_l,theta_v,phi_v\na.png,0.7853981633974483,3.14159,0,0\nb.png,0.5,0,0,0\n";
  EXPECT_NE(refusal(text).find("--angles degrees or --angles radians"), std::string::npos) << refusal(text);
  EXPECT_NEAR(read_csv_index(path_, BtfAngles::radians)[0].light.theta, 45, 1e-12);
  EXPECT_EQ(read_csv_index(path_, BtfAngles::degrees)[1].light.theta, 0.5);
}

TEST_F(CsvIndexTest, WhatIsWrongIsOneSentenceWithItsLine) {
  const std::string head = "file,theta_l,phi_l,theta_v,phi_v\n";
  EXPECT_EQ(refusal("file;theta_l;phi_l;theta_v;phi_v\n"),
            ": line 1: the first line has no column 'file'; it must contain file, theta_l, phi_l, theta_v and phi_v, "
            "separated by commas.");
  EXPECT_EQ(refusal("file,theta_l,phi_l,theta_v\n").substr(0, 47), ": line 1: the first line has no column 'phi_v';");
  EXPECT_NE(refusal("").find(": line 0: the first line has no column 'file'"), std::string::npos);
  EXPECT_EQ(refusal(head), ": line 1: the file lists no images.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3\n"), ": line 2: the line has 4 fields, but the first line names 5 columns.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3,4\n#\nb.png,1,two,3,4\n"),
            ": line 4: 'phi_l' is 'two'; it must be a number from -1000000 to 1000000, such as 15.5.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3,nan\n"),
            ": line 2: 'phi_v' is 'nan'; it must be a number from -1000000 to 1000000, such as 15.5.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3,4 5\n"),
            ": line 2: 'phi_v' is '4 5'; it must be a number from -1000000 to 1000000, such as 15.5.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3,1e400\n"),
            ": line 2: 'phi_v' is '1e400'; it must be a number from -1000000 to 1000000, such as 15.5.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3,\"1,5\"\n"),
            ": line 2: 'phi_v' is '1,5'; it must be a number from -1000000 to 1000000, such as 15.5.");
  EXPECT_EQ(refusal(head + "a.png,-1,2,3,4\n"), ": line 2: 'theta_l' is negative; it must be at least 0.");
  EXPECT_EQ(refusal(head + ",1,2,3,4\n"), ": line 2: 'file' is empty.");
  EXPECT_EQ(refusal(head + "a.png,1,2,3,4\nb.png,1,2,3,4\n"),
            ": line 3: an earlier line has the same angles; remove one of the two.");
  EXPECT_EQ(refusal("file," + head),
            ": line 1: the first line names the column 'file' more than once; remove all but one.");
  EXPECT_TRUE(is_csv_index(path_));
  EXPECT_EQ(refusal("file,theta_l,phi_l,theta_v,phi_v,view,light\na.png,1,0,2,0,1.5,0\n"),
            ": line 2: 'view' is '1.5'; it must be an integer.");
  EXPECT_EQ(refusal("view," + head), ": line 1: the columns 'view' and 'light' must be given together.");
}

TEST_F(CsvIndexTest, ManyColumnsTakeNoTime) {
  std::string text = "file,theta_l,phi_l,theta_v,phi_v";
  for (int i = 0; i < 100000; ++i) text.append(",c").append(std::to_string(i));
  const double start = thread_seconds();
  EXPECT_EQ(refusal(text + "\n"), ": line 1: the file lists no images.");
  EXPECT_LT(thread_seconds() - start, 1.0);
}

}  // namespace
}  // namespace velour::csv_index_test
