// Bytes as text and back.
#include "base/json_fields.h"

#include <gtest/gtest.h>

namespace velour::base64_test {
namespace {

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Base64, AgreesWithTheStandard) {  // RFC 4648, section 10
  const char* pairs[][2] = {{"", ""},
                            {"f", "Zg=="},
                            {"fo", "Zm8="},
                            {"foo", "Zm9v"},
                            {"foob", "Zm9vYg=="},
                            {"fooba", "Zm9vYmE="},
                            {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, encoded] : pairs) {
    EXPECT_EQ(base64(bytes_of(plain)), encoded);
    EXPECT_EQ(parse_base64(encoded), bytes_of(plain));
  }
}

TEST(Base64, EveryByteSurvives) {
  std::vector<uint8_t> bytes;
  for (int i = 0; i < 1000; ++i) bytes.push_back(static_cast<uint8_t>(i * 37));
  for (size_t size = 997; size <= 1000; ++size) {
    const std::vector<uint8_t> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(parse_base64(base64(part)), part);
  }
}

TEST(Base64, WhatNoBytesGiveIsRefused) {
  for (const char* text :
       {"Z", "Zg", "Zg=", "Zg= ", "Zh==", "Zm9=", "Zg==Zg==", "====", "Z===", "Zm 9", "Zm9v\n", "Zm-_"}) {
    EXPECT_FALSE(parse_base64(text)) << text;
  }
}

}  // namespace
}  // namespace velour::base64_test
