// Files that lie, end early, or were damaged.
#include <gtest/gtest.h>

#include <functional>

#include "example_model.h"
#include "image/exr_tensors.h"
#include "job/error.h"
#include "model/model_file.h"
#include "sphere/random.h"

namespace velour {
namespace {

/// What decode_model says to the example with `change` made to its file; "" when it accepts it.
std::string complaint(const std::function<void(TensorFile&)>& change, Kernel kernel = Kernel::gaussian) {
  TensorFile file = decode_tensors(encode_model(test::example_model(kernel)), "example");
  change(file);
  try {
    decode_model(encode_tensors(file), "metal.velour");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

void expect_named(const std::string& complaint, const std::string& field) {
  EXPECT_EQ(complaint.find("metal.velour"), 0u) << complaint;
  EXPECT_NE(complaint.find(field), std::string::npos) << complaint << " should name " << field;
}

auto set(const std::string& part, size_t i, float value) {
  return [=](TensorFile& file) { file.tensors.at(part).data.at(i) = value; };
}

auto attribute(const std::string& key, const std::string& value) {
  return [=](TensorFile& file) { file.attributes[key] = value; };
}

TEST(HostileModel, TheUnchangedExampleIsAccepted) {
  EXPECT_EQ(complaint([](TensorFile&) {}), "");
}

TEST(HostileModel, ValuesOutOfRangeAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  expect_named(complaint(set("lobes.center", 3, 2)), "lobes.center[1]");
  expect_named(complaint(set("lobes.center", 0, nan)), "lobes.center[0]");
  expect_named(complaint(set("lobes.bandwidth", 2, 0)), "lobes.bandwidth[2]");
  expect_named(complaint(set("lobes.bandwidth", 2, infinity)), "lobes.bandwidth[2]");
  expect_named(complaint(set("lobes.bandwidth", 1, 1), Kernel::abel_poisson), "lobes.bandwidth[1]");
  expect_named(complaint(set("lobes.coefficient", 4, -1e-6f)), "lobes.coefficient[1]");
  expect_named(complaint(set("lobes.coefficient", 4, nan)), "lobes.coefficient[1]");
  expect_named(complaint(set("views.diffuse", 7, -1)), "views.diffuse[2]");
  expect_named(complaint(set("views.direction", 2, -1)), "views.direction[0]");
  expect_named(complaint(set("views.lobe_count", 1, 2)), "views.lobe_count");
  expect_named(complaint(set("views.lobe_count", 1, 0.5f)), "views.lobe_count[1]");
  expect_named(complaint(set("views.lobe_count", 1, -1)), "views.lobe_count[1]");
  expect_named(complaint(set("views.lobe_count", 1, 1e9f)), "views.lobe_count[1]");
}

TEST(HostileModel, ViewsMustLieOnTheMeridianInOrder) {
  expect_named(complaint([](TensorFile& f) {
                 std::swap(f.tensors["views.direction"].data[3], f.tensors["views.direction"].data[4]);
               }),
               "views.direction[1]");
  expect_named(complaint([](TensorFile& f) {
                 auto& d = f.tensors["views.direction"].data;
                 std::swap_ranges(d.begin() + 3, d.begin() + 6, d.begin() + 6);
               }),
               "views.direction[2]");
}

TEST(HostileModel, NearlyUnitCentresAreMadeUnit) {
  TensorFile file = decode_tensors(encode_model(test::example_model()), "example");
  for (float& x : file.tensors["lobes.center"].data) x *= 1.0005f;
  const Model model = decode_model(encode_tensors(file), "metal.velour");
  for (const Vec3& c : std::get<ScatteredBrdf>(model.body).center) EXPECT_NEAR(glm::length(c), 1, 1e-6);
}

TEST(HostileModel, MissingOrMisshapenPartsAreNamed) {
  for (const char* part :
       {"lobes.center", "lobes.bandwidth", "lobes.coefficient", "views.direction", "views.lobe_count"}) {
    expect_named(complaint([part](TensorFile& f) { f.tensors.erase(part); }), part);
    expect_named(complaint([part](TensorFile& f) { f.tensors[part] = {{2, 2}, {1, 2, 3, 4}}; }), part);
  }
  expect_named(complaint([](TensorFile& f) { f.tensors["lobes.bandwidth"] = {{1}, {1}}; }), "lobes.bandwidth");
}

TEST(HostileModel, AttributesAreChecked) {
  for (const char* key : {"velour.kind", "velour.model", "velour.kernel", "velour.parameterisation", "velour.isotropic",
                          "velour.align_views", "velour.neighbors", "velour.fit", "velour.format_version"}) {
    expect_named(complaint([key](TensorFile& f) { f.attributes.erase(key); }), key);
    expect_named(complaint(attribute(key, "nonsense")), key);
  }
  expect_named(complaint(attribute("velour.neighbors", "0")), "velour.neighbors");
  expect_named(complaint(attribute("velour.neighbors", "1000000")), "velour.neighbors");
  expect_named(complaint(attribute("velour.fit", "{\"relative_l2\": \"x\"}")), "relative_l2");
  expect_named(complaint(attribute("velour.fit", "{\"by_view_angle\": {\"5\": -1}}")), "by_view_angle");
  expect_named(complaint(attribute("velour.fit", std::string(100000, '['))), "velour.fit");
}

TEST(HostileModel, UnknownPartsAndAttributesAreIgnored) {
  EXPECT_EQ(complaint([](TensorFile& f) {
              f.tensors["future.part"] = {{2}, {1, 2}};
              f.attributes["velour.future"] = "yes";
            }),
            "");
  EXPECT_EQ(complaint(attribute("velour.format_version", "1.9")), "");
}

TEST(HostileModel, ANewerFormatIsRefusedWithASentence) {
  const std::string sentence = complaint(attribute("velour.format_version", "2.0"));
  EXPECT_NE(sentence.find("2.0"), std::string::npos);
  EXPECT_NE(sentence.find("newer Velour"), std::string::npos);
}

TEST(HostileModel, TruncatedFilesAreRefused) {
  const auto bytes = encode_model(test::example_model());
  for (size_t length = 0; length < bytes.size(); length += 13) {
    EXPECT_THROW(decode_model(std::span(bytes).first(length), "cut"), Error) << length;
  }
}

TEST(HostileModel, DamagedFilesAreRefusedOrSound) {
  const auto good = encode_model(test::example_model());
  for (uint64_t trial = 0; trial < 3000; ++trial) {
    auto bytes = good;
    RandomStream random(17, trial, 0);
    for (int i = 0; i < 4; ++i) bytes[random.next_bits() % bytes.size()] = static_cast<uint8_t>(random.next_bits());
    try {
      const Model model = decode_model(bytes, "damaged");
      const auto& brdf = std::get<ScatteredBrdf>(model.body);
      ASSERT_EQ(brdf.first_lobe.back(), brdf.center.size());
      make_material(std::make_shared<const Model>(model), 0);
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace velour
