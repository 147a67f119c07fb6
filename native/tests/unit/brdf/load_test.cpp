#include <gtest/gtest.h>

#include "brdf/measurement.h"
#include "file/file.h"
#include "measurement_support.h"
#include "support/test_data.h"

namespace velour {
namespace {

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Load, RecognisesByContentNotByName) {
  const auto folder = test::scratch_folder();
  const auto rgl = test::small_rgl({0.0f}, [](size_t, size_t, size_t, size_t) { return Rgb(1.0f); }).bytes();
  write_file(folder / "a.binary", rgl);
  EXPECT_TRUE(is_measurement_file(folder / "a.binary"));
  const auto measurement = load_measurement(folder / "a.binary");
  EXPECT_EQ(measurement->provenance().format, "rgl");
  EXPECT_EQ(measurement->provenance().name, "a");
  EXPECT_EQ(measurement->provenance().path, (folder / "a.binary").string());
  EXPECT_EQ(measurement->provenance().file_bytes, rgl.size());
  EXPECT_EQ(measurement->provenance().sha256, sha256_hex(rgl));
  EXPECT_FALSE(measurement->details().empty());
}

TEST(Load, UnknownContentIsUnsupported) {
  const std::string path = test::scratch_folder() / "a.bsdf";
  for (const std::string content : {"", "hello", "v 0 0 0\n", "tensor_fil"}) {
    write_file(path, bytes_of(content));
    EXPECT_FALSE(is_measurement_file(path));
    try {
      load_measurement(path);
      FAIL() << content;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::unsupported);
      EXPECT_NE(std::string(error.what()).find("a.bsdf"), std::string::npos);
    }
  }
}

TEST(Load, MissingFileIsAnIoError) {
  try {
    load_measurement("/nowhere/at/all.binary");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::io);
  }
}

}  // namespace
}  // namespace velour
