// Damaged BTFs, by the thousand: each is read or refused with a sentence that names the file, and nothing else happens.
// The seed is fixed; run it under the sanitize preset to see reads outside the file.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "btf/formats/btf_export.h"
#include "btf/formats/btf_folder.h"
#include "btf/formats/load_btf.h"
#include "btf_support.h"
#include "support/mutation.h"
#include "support/test_data.h"
#include "ubo_support.h"

namespace velour::hostile_btf_test {
namespace {

using Bytes = std::vector<uint8_t>;

void read_all(const std::string& path) {
  const auto btf = load_btf(path);
  test::all_pairs(*btf);
  for (uint32_t v = 0; v < btf->layout().views().size(); ++v) btf->read_structure(v);
}

/// Without waiting for the disk, as write_file does.
void overwrite(const std::string& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Damages `file`, a part of the BTF at `path`.
void attack(const std::string& path, const std::string& file, uint64_t trials) {
  const Bytes good = read_file(file);
  ASSERT_EQ(test::message_of([&] { read_all(path); }), "");
  int refused = 0;
  for (uint64_t trial = 0; trial < trials; ++trial) {
    RandomStream random(99, 0, trial);
    Bytes bytes = good;
    for (uint64_t changes = 1 + random.next_bits() % 4; changes > 0; --changes) test::mutate(bytes, random);
    overwrite(file, bytes);
    const std::string message = test::message_of([&] { read_all(path); });
    refused += !message.empty();
    EXPECT_TRUE(message.empty() || message.starts_with(path)) << message;
  }
  ::testing::Test::RecordProperty("refused", refused);
  EXPECT_GT(refused, 20);
}

TEST(HostileBtf, Index) {
  const std::string path = test::scratch_folder() / "tile";
  test::RandomBtf(test::small_index(), 1).write(path);
  attack(path, path + "/btf.json", 400);
}

/// Not by the end of the stack.
TEST(HostileBtf, IndexThatIsNestedDeep) {
  const std::string path = test::scratch_folder() / "tile";
  test::RandomBtf(test::small_index(), 1).write(path);
  const Bytes good = read_file(path + "/btf.json");
  const std::string whole(good.begin(), good.end());
  const std::string deep = std::string(300000, '[') + std::string(300000, ']');
  for (const std::string& text : {"{\"format\": " + deep + "}",
                                  whole.substr(0, whole.rfind('}')) + ", \"options\": {\"nested\": " + deep + "}}"}) {
    overwrite(path + "/btf.json", {text.begin(), text.end()});
    const std::string message = test::message_of([&] { read_all(path); });
    EXPECT_NE(message.find("is not the index of a BTF"), std::string::npos) << message.substr(0, 300);
  }
}

TEST(HostileBtf, View) {
  const std::string path = test::scratch_folder() / "tile";
  test::RandomBtf(test::small_index(), 1).write(path);
  attack(path, view_path(path, 0), 400);
}

TEST(HostileBtf, UboFile) {
  const std::string path = test::scratch_folder() / "a.btf";
  test::UboExample example;
  example.randomize(1);
  write_file(path, example.bytes());
  attack(path, path, 1000);
}

TEST(HostileBtf, CsvIndex) {
  const auto folder = test::scratch_folder();
  test::RandomBtf({PairLayout(even_directions(3), even_directions(2)), {2, 2}}, 1).write(folder / "tile");
  Progress progress;
  export_btf(*load_btf(folder / "tile"), folder / "set", progress);
  attack(folder / "set", folder / "set/btf.csv", 300);
}

}  // namespace
}  // namespace velour::hostile_btf_test
