// Numbers and comments of text files as other programs write them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/text_head.h"
#include "base/text_number.h"
#include "support/test_data.h"

namespace velour::text_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(TextNumber, IsReadWithAndWithoutSignAndExponent) {
  for (const char* text : {"0.17", "+0.17", "0.170", ".17", "+.17", "1.7e-1", "+1.7E-01", "17e-2"})
    EXPECT_EQ(number_from(text), 0.17) << text;
  EXPECT_EQ(number_from("-2"), -2);
  EXPECT_EQ(number_from("5."), 5);
  EXPECT_TRUE(std::isnan(number_from("+nan").value()));
  EXPECT_EQ(leading_number("+1.5,2")->length, 4u);
}

TEST(TextNumber, OtherWordsAreNone) {
  for (const char* text : {"", "+", "-", "+-1", "++1", "-+1", "1,5", "1.5 ", " 1", "x", "1.5x", "1D3", "0x10"})
    EXPECT_FALSE(number_from(text)) << text;
}

TEST(TextNumber, BeyondADoubleIsInfinityOrZero) {
  const std::string zeros(400, '0');
  for (const std::string& text : {std::string("1e400"), "1" + zeros, std::string("+1e99999999999999999999")})
    EXPECT_EQ(number_from(text), kInfinity) << text;
  EXPECT_EQ(number_from("-1e400"), -kInfinity);
  for (const std::string& text : {std::string("1e-400"), "0." + zeros + "1", std::string("1e-99999999999999999999")})
    EXPECT_EQ(number_from(text), 0) << text;
  EXPECT_EQ(number_from("0e999"), 0);
  EXPECT_NEAR(number_from("0." + zeros + "1e401").value(), 1, 1e-12) << "control";
}

class TextHead : public testing::Test {
 protected:
  std::string head_of(const std::string& text, Comments comments, size_t count = 100) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_text_head(path_, count, comments);
  }
  std::string path_ = test::scratch_folder() / "a.txt";
};

TEST_F(TextHead, CommentsOfAnyLengthAreSkipped) {
  std::string lines, sections = "<!--" + std::string(200000, '-') + "-->";
  for (int i = 0; i < 9000; ++i) {
    lines += "# line of a report\n";
    sections += "<!-- a license --> \n";
  }
  EXPECT_EQ(head_of("\xef\xbb\xbf" + lines + "3 # count\r" + lines + " 450\t550\n\n", Comments::hash), "3\n450 550");
  EXPECT_EQ(head_of(lines + "a#1, b\r\n  # c\r\nd", Comments::hash_lines), "a#1, b\nd");
  EXPECT_EQ(head_of("<?xml version='1.0'?>" + sections + "<a>" + sections + "b", Comments::xml), "<a>\nb");
  EXPECT_EQ(head_of("<!-- without end ->", Comments::xml), "");
  EXPECT_EQ(head_of("#", Comments::hash), "");
}

TEST_F(TextHead, IsAsLongAsAskedFor) {
  EXPECT_EQ(head_of(std::string(300000, 'x'), Comments::hash, 5000), std::string(5000, 'x'));
  EXPECT_EQ(head_of("a  b  c", Comments::hash, 2), "a ");
  EXPECT_EQ(head_of("", Comments::xml), "");
}

/// A comment is recognized wherever the blocks that are read divide it.
TEST_F(TextHead, BlocksDivideComments) {
  constexpr size_t kBlock = 1 << 16;
  for (size_t before = kBlock - 12; before < kBlock + 2; ++before) {
    EXPECT_EQ(head_of("<r" + std::string(before, ' ') + "<!--x-->y", Comments::xml), "<r y") << before;
  }
}

TEST_F(TextHead, Utf16IsReadAsAscii) {
  const std::string ascii = "<?xml?><!-- x --><Root>";
  std::string little = "\xff\xfe", big = "\xfe\xff";
  for (const char c : ascii) {
    little += std::string{c, '\0'};
    big += std::string{'\0', c};
  }
  EXPECT_EQ(head_of(little, Comments::xml), "<Root>");
  EXPECT_EQ(head_of(big, Comments::xml), "<Root>");
}

}  // namespace
}  // namespace velour::text_test
