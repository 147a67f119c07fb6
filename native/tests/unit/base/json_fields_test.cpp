// Limits of JSON that files may contain.
#include "base/json_fields.h"

#include <gtest/gtest.h>

#include "base/process.h"

namespace velour::json_fields_test {
namespace {

std::string repeated(const std::string& text, size_t count) {
  std::string result;
  for (size_t i = 0; i < count; ++i) result += text;
  return result;
}

std::string nested(size_t levels) { return repeated("[", levels) + "1" + repeated("]", levels); }

std::string object_of(size_t members) {
  std::string text = "{";
  for (size_t i = 0; i < members; ++i) text += (i > 0 ? ",\"" : "\"") + std::to_string(i) + "\":0";
  return text + "}";
}

TEST(ParseJson, LimitsTheDepthOutsideStrings) {
  EXPECT_FALSE(parse_json(nested(32)).is_discarded());
  EXPECT_TRUE(parse_json(nested(33)).is_discarded());
  EXPECT_TRUE(parse_json(repeated("{\"a\":", 33) + "1" + repeated("}", 33)).is_discarded());
  EXPECT_EQ(parse_json("\"" + repeated("[\\\"{", 100) + "\""), repeated("[\"{", 100));
  EXPECT_EQ(parse_json("[" + repeated("[[]],", 100) + "{}]").size(), 101u);
}

TEST(ParseJson, LimitsTheMembersOfAnObject) {
  EXPECT_EQ(parse_json(object_of(1024)).size(), 1024u);
  EXPECT_TRUE(parse_json(object_of(1025)).is_discarded());
  EXPECT_EQ(parse_json("[" + object_of(1000) + "," + object_of(1000) + ",\"" + repeated(":", 2000) + "\"]").size(), 3u);
}

TEST(ParseJson, RefusesOtherText) {
  for (const char* text : {"", "{", "]", "[1,]", "{\"a\"}", "\"", "\"\\", "a:b"}) {
    EXPECT_TRUE(parse_json(std::string(text)).is_discarded()) << text;
  }
}

TEST(ParseJson, ManyObjectsTakeNoTime) {
  const double start = thread_seconds();
  EXPECT_EQ(parse_json("[" + repeated("{},", 200000) + "{}]").size(), 200001u);
  EXPECT_LT(thread_seconds() - start, 1.0);
}

}  // namespace
}  // namespace velour::json_fields_test
