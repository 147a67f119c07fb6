#include <gtest/gtest.h>

#include "base/file.h"
#include "brdf/measure/measurement.h"
#include "measurement_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::load_test {
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

std::string text_of_cornell(const std::string& comment, const std::string& end) {
  std::string text = comment + "1 550" + end;
  for (int i = 0; i < 60; ++i)
    text += "0." + std::to_string(100 + 7 * i) + " 0 0." + std::to_string(120 + 11 * i) + " " + std::to_string(i % 3) +
            " 0.25" + end;
  return text;
}

TEST(Load, CornellBehindCommentsOfAnyLength) {
  test::record_input("Cornell .brdf", "comments of any length, UTF-8 mark, LF, CRLF, CR", "read");
  const std::string path = test::scratch_folder() / "a.brdf";
  const std::string protocol = [] {
    std::string lines;
    for (int i = 0; i < 3000; ++i) lines += "# line " + std::to_string(i) + " of the laboratory's protocol\n";
    return lines;
  }();
  for (const std::string& begin : {std::string(), protocol, "\xef\xbb\xbf" + protocol, std::string("\xef\xbb\xbf")}) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
      std::string text;
      for (const char c : text_of_cornell(begin, "\n")) text += c == '\n' ? end : std::string(1, c);
      write_file(path, std::vector<uint8_t>(text.begin(), text.end()));
      EXPECT_TRUE(is_measurement_file(path));
      EXPECT_EQ(load_measurement(path)->samples().size(), 60u) << begin.size() << ' ' << int{end[0]};
    }
  }
}

/// The count and the first wavelength may be far apart.
TEST(Load, CornellWithCommentsBetweenItsFirstNumbers) {
  test::record_input("Cornell .brdf", "long comments between count and wavelengths", "read");
  const std::string path = test::scratch_folder() / "a.brdf";
  std::string text = text_of_cornell("", "\n");
  std::string comment;
  for (int i = 0; i < 4000; ++i) comment += "# about the wavelengths\n";
  text.replace(1, 1, " # one\n" + comment);
  write_file(path, bytes_of(text));
  EXPECT_EQ(load_measurement(path)->samples().size(), 60u);
}

TEST(Load, IrregularSamplesCanBeCancelled) {
  const std::string path = test::scratch_folder() / "a.brdf";
  write_file(path, bytes_of(text_of_cornell("", "\n")));
  Progress progress;
  EXPECT_EQ(load_measurement(path, progress)->samples().size(), 60u) << "control";
  progress.cancel();
  try {
    load_measurement(path, progress);
    FAIL() << "was read to the end";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::cancelled);
  }
}

TEST(Load, NamesOtherFormatsAndWhatToDo) {
  const std::string license = "<!--" + std::string(100000, ' ') + "license -->";
  const std::pair<std::string, const char*> others[] = {
      {"\x89HDF\r\n\x1a\n....", "AxF"},
      {"7z\xbc\xaf\x27\x1c....", ".sbsar"},
      {"PK\x03\x04....", ".vrscan"},
      {"<?xml version='1.0'?>\n<materialx version='1.38'>", "MaterialX"},
      {"<?xml version='1.0'?>\n" + license + "\n<materialx version='1.38'>", "MaterialX"},
      {"# ASTM E1392\nVARS theta_i", "ASTM"},
      {"; astm e 1392-96(2002) BRDF\r\n1 2 3\r\n", "ASTM"},
      {"LAB_NAME Lab\nNUM_POINTS 1\nVARS theta_i,phi_i,theta_s,465nm\n0,0,0,1\n", "ASTM"}};
  const std::string path = test::scratch_folder() / "a.bin";
  for (const auto& [head, words] : others) {
    test::record_input(words, "any", "refused by name, with what to do");
    write_file(path, bytes_of(head));
    const std::string said = test::refusal([&] { load_measurement(path); });
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_FALSE(is_measurement_file(path));
  }
  test::record_input("MaterialX", "long comments before the root", "refused by name, with what to do");
}

/// A name in a text does not make its format.
TEST(Load, TextsThatCiteAFormatAreNotOfIt) {
  const std::string path = test::scratch_folder() / "a.bin";
  for (const char* text :
       {"nothing that is known", "%PDF-1.4 ASTM", "measured after ASTM E1392", "ASTM E308",
        "<report>\nASTM E1392\n</report>", "<!-- <materialx> --><report/>", "VARS mass, length\n1 2"}) {
    write_file(path, bytes_of(text));
    EXPECT_NE(test::refusal([&] { load_measurement(path); }).find("not a measurement in a supported"),
              std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace velour::load_test
