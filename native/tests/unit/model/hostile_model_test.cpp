// Files that lie, end early, or were damaged.
#include <gtest/gtest.h>

#include "btf/model/factored_btf.h"
#include "example_model.h"
#include "math/sphere/random.h"
#include "model/model.h"
#include "unit/model/refusals.h"

namespace velour::hostile_model_test {
namespace {

using test::expect_named;
using test::FileChange;
using test::set_value;
const auto complaint_of = test::refusal_of;

std::string complaint(const FileChange& change, Kernel kernel = Kernel::gaussian) {
  return complaint_of(test::example_model(kernel), change);
}

std::string parametric_complaint(const FileChange& change) { return complaint_of(test::example_parametric(), change); }

auto attribute(const std::string& key, const std::string& value) {
  return [=](TensorFile& file) { file.attributes[key] = value; };
}

TEST(HostileModel, TheUnchangedExampleIsAccepted) {
  EXPECT_EQ(complaint([](TensorFile&) {}), "");
  EXPECT_EQ(parametric_complaint([](TensorFile&) {}), "");
}

TEST(HostileModel, ValuesOutOfRangeAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  expect_named(complaint(set_value("lobes.center", 3, 2)), "lobes.center[1]");
  expect_named(complaint(set_value("lobes.center", 0, nan)), "lobes.center[0]");
  expect_named(complaint(set_value("lobes.bandwidth", 2, 0)), "lobes.bandwidth[2]");
  expect_named(complaint(set_value("lobes.bandwidth", 2, infinity)), "lobes.bandwidth[2]");
  expect_named(complaint(set_value("lobes.bandwidth", 1, 1), Kernel::abel_poisson), "lobes.bandwidth[1]");
  expect_named(complaint(set_value("lobes.coefficient", 4, -1e-6f)), "lobes.coefficient[1]");
  expect_named(complaint(set_value("lobes.coefficient", 4, nan)), "lobes.coefficient[1]");
  expect_named(complaint(set_value("views.diffuse", 7, -1)), "views.diffuse[2]");
  expect_named(complaint(set_value("views.direction", 2, -1)), "views.direction[0]");
  expect_named(complaint(set_value("views.lobe_count", 1, 2)), "views.lobe_count");
  expect_named(complaint(set_value("views.lobe_count", 1, 0.5f)), "views.lobe_count[1]");
  expect_named(complaint(set_value("views.lobe_count", 1, -1)), "views.lobe_count[1]");
  expect_named(complaint(set_value("views.lobe_count", 1, 1e9f)), "views.lobe_count[1]");
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

TEST(HostileModel, NearlyUnitCentersAreMadeUnit) {
  TensorFile file = decode_tensors(encode_model(test::example_model()), "example");
  for (float& x : file.tensors["lobes.center"].data) x *= 1.0005f;
  const Model model = decode_model(encode_tensors(file), "metal.velour");
  for (const Vec3& c : std::get<PerViewBrdf>(model.body).center) EXPECT_NEAR(glm::length(c), 1, 1e-6);
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

TEST(HostileModel, ParametricValuesOutOfRangeAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  expect_named(parametric_complaint(set_value("lobes.space", 2, 2)), "lobes.space[2]");
  expect_named(parametric_complaint(set_value("lobes.space", 2, 0.5f)), "lobes.space[2]");
  expect_named(parametric_complaint(set_value("lobes.space", 2, nan)), "lobes.space[2]");
  // [node][parameter][lobe], five lobes: the second of each parameter.
  const auto first = [](int parameter) { return static_cast<size_t>(5 * parameter + 1); };
  const std::pair<int, float> hostile[] = {
      {ParametricBrdf::kLogBandwidth, 21.0f}, {ParametricBrdf::kLogBandwidth, -12.0f},
      {ParametricBrdf::kLogRed, 28.0f},       {ParametricBrdf::kLogGreen, -41.0f},
      {ParametricBrdf::kLogBlue, infinity},   {ParametricBrdf::kTiltX, 3.15f},
      {ParametricBrdf::kTiltX, -infinity},    {ParametricBrdf::kStretchA, -6.01f},
      {ParametricBrdf::kStretchA, nan},       {ParametricBrdf::kLogBandwidth, infinity}};
  for (const auto& [parameter, value] : hostile) {
    const std::string said = parametric_complaint(set_value("lobes.control", first(parameter), value));
    expect_named(said, "lobes.control[" + std::to_string(first(parameter)) + "]");
  }
  expect_named(parametric_complaint(set_value("lobes.control", first(ParametricBrdf::kTiltX), 4)), "tilt in radians");
}

TEST(HostileModel, ParametricPartsAndAttributesAreChecked) {
  for (const char* part : {"lobes.space", "lobes.control"}) {
    expect_named(parametric_complaint([part](TensorFile& f) { f.tensors.erase(part); }), part);
    expect_named(parametric_complaint([part](TensorFile& f) { f.tensors[part] = {{2, 2}, {1, 1, 1, 1}}; }), part);
  }
  expect_named(parametric_complaint([](TensorFile& f) {
                 f.tensors.clear();
                 f.tensors["other"] = {{1}, {1}};
               }),
               "lobes.none");
  expect_named(parametric_complaint([](TensorFile& f) {
                 f.tensors["lobes.space"] = {{33}, std::vector<float>(33)};
               }),
               "lobes.space");
  for (const char* key : {"velour.isotropic", "velour.cells"}) {
    expect_named(parametric_complaint([key](TensorFile& f) { f.attributes.erase(key); }), key);
    expect_named(parametric_complaint(attribute(key, "nonsense")), key);
  }
  expect_named(parametric_complaint(attribute("velour.cells", "0")), "velour.cells");
  expect_named(parametric_complaint(attribute("velour.cells", "65")), "velour.cells");
  expect_named(parametric_complaint(attribute("velour.cells", "11")), "velour.cells");
  expect_named(parametric_complaint(attribute("velour.isotropic", "false")), "lobes.control");
}

TEST(HostileModel, ViewsOfReducedModelsAreChecked) {
  const auto complaint_of_reduced = [](const FileChange& change) {
    return complaint_of(test::example_reduced(), change);
  };
  EXPECT_EQ(complaint_of_reduced([](TensorFile&) {}), "");
  expect_named(complaint_of_reduced(attribute("velour.first_view", "-1")), "velour.first_view");
  expect_named(complaint_of_reduced(attribute("velour.last_view", "30")), "velour.last_view");
  expect_named(complaint_of_reduced(attribute("velour.last_view", "91")), "velour.last_view");
  expect_named(complaint_of_reduced([](TensorFile& f) { f.attributes.erase("velour.last_view"); }), "velour.last_view");
  expect_named(complaint_of_reduced([](TensorFile& f) { f.attributes.erase("velour.scene"); }), "velour.scene");
}

TEST(HostileModel, TheSceneRecordIsChecked) {
  const TensorFile file = decode_tensors(encode_model(test::example_reduced()), "example");
  const std::string whole = file.attributes.at("velour.scene");
  const auto with = [&whole](const std::string& from, const std::string& to) {
    std::string text = whole;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return complaint_of(test::example_reduced(), attribute("velour.scene", text));
  };
  EXPECT_EQ(with("\"frames\":2", "\"frames\":3"), "");
  expect_named(with("\"frames\":2", "\"frames\":-2"), "'frames'");
  expect_named(with("\"camera_rays\":131072", "\"camera_rays\":\"many\""), "'camera_rays'");
  expect_named(with("\"light_density\":3.25", "\"light_density\":-1"), "'light_density'");
  expect_named(with("\"hash\":\"", "\"hash\":\"x"), "'hash'");
  expect_named(with("\"first_view\":31", "\"first_view\":80"), "'view_weights'");
  expect_named(with("\"first_view\":31", "\"first_view\":1e300"), "'first_view'");
  expect_named(with("\"view_weights\":[", "\"view_weights\":[null,"), "'view_weights'");
  expect_named(with("\"picture_error\"", "\"pictures\""), "'picture_error'");
  expect_named(complaint_of(test::example_reduced(), attribute("velour.scene", "[]")), "velour.scene");
}

TEST(HostileModel, TheOrderIsChecked) {
  const auto order = [](const std::string& json) {
    return complaint(attribute("velour.fit", "{\"order\": " + json + "}"));
  };
  const std::string columns = R"("parameter_bytes": [1], "worst": [1], "relative_l2": [1]})";
  EXPECT_EQ(order(R"({"lobes": [1], )" + columns), "");
  EXPECT_EQ(order(R"({"lobes": [1], "chosen": 0, )" + columns), "");
  expect_named(order("3"), "order");
  expect_named(order("{}"), "lobes");
  expect_named(order(R"({"lobes": [1, 2], )" + columns), "differ in length");
  for (const std::string lobes : {"1", "[-1]", "[1e30]", "[null]", "[\"1\"]"}) {
    expect_named(order(R"({"lobes": )" + lobes + ", " + columns), "'lobes'");
  }
  for (const std::string chosen : {"1", "-1", "0.5", "\"0\""}) {
    expect_named(order(R"({"lobes": [1], "chosen": )" + chosen + ", " + columns), "'chosen'");
  }
}

TEST(HostileModel, TheVerdictIsChecked) {
  const auto verdict = [](const std::string& json) {
    return complaint(attribute("velour.fit", "{\"verdict\": " + json + "}"));
  };
  const std::string numbers = R"(, "flip_mean": 0.1, "flip_95": 0.2, "value": 0)";
  EXPECT_EQ(verdict(R"({"quality": "poor", "reason": "color")" + numbers + "}"), "");
  EXPECT_EQ(verdict(R"({"quality": "good", "reason": null)" + numbers + "}"), "");
  EXPECT_EQ(verdict(R"({"quality": "fair", "reason": "of a later version")" + numbers + "}"), "");
  expect_named(verdict("3"), "verdict");
  expect_named(verdict("{}"), "'quality'");
  expect_named(verdict(R"({"quality": "fine", "reason": null)" + numbers + "}"), "'quality'");
  expect_named(verdict(R"({"quality": "good", "reason": 7)" + numbers + "}"), "'reason'");
  expect_named(verdict(R"({"quality": "good", "reason": null, "flip_mean": -1, "flip_95": 0, "value": 0})"),
               "'flip_mean'");
}

/// Not by the end of the stack.
TEST(HostileModel, WhatIsNestedDeepIsRefused) {
  const std::string deep = std::string(300000, '[') + std::string(300000, ']');
  const std::string columns = R"("lobes": [1], "parameter_bytes": [1], "worst": [1], "relative_l2": [1])";
  expect_named(complaint(attribute("velour.fit", R"({"order": {"chosen": )" + deep + ", " + columns + "}}")),
               "velour.fit");
  const auto complaint_of_btf = [](const std::string& index) {
    return complaint_of(test::example_btf_model(), attribute("velour.btf.index", index));
  };
  expect_named(complaint_of_btf(R"({"format": )" + deep + "}"), "format 'velour-btf'");
  const TensorFile file = decode_tensors(encode_model(test::example_btf_model()), "example");
  std::string index = file.attributes.at("velour.btf.index");
  index.insert(index.rfind('}'), R"(, "options": {"nested": )" + deep + "}");
  expect_named(complaint_of_btf(index), "format 'velour-btf'");
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

std::vector<Model> examples() {
  return {test::example_model(),         test::example_parametric(), test::example_reduced(),
          test::example_btf_model(),     test::example_srbf_model(), test::example_tensor_model(),
          test::example_view_svd_model()};
}

TEST(HostileModel, TruncatedFilesAreRefused) {
  for (const Model& model : examples()) {
    const auto bytes = encode_model(model);
    for (size_t length = 0; length < bytes.size(); length += 13) {
      EXPECT_THROW(decode_model(std::span(bytes).first(length), "cut"), Error) << length;
    }
  }
}

void expect_sound(const PerViewBrdf& brdf) { ASSERT_EQ(brdf.first_lobe.back(), brdf.center.size()); }

void expect_sound(const ParametricBrdf& brdf) {
  for (const float angle : {0.0f, 0.7f, 1.57f}) {
    for (const WarpedLobe& lobe : lobes_at(brdf, Vec3d(direction(angle, 0.3f)))) {
      ASSERT_TRUE(std::isfinite(lobe.bandwidth) && lobe.bandwidth > 0);
      ASSERT_TRUE(std::isfinite(lobe.coefficient.x + lobe.coefficient.y + lobe.coefficient.z));
    }
  }
}

void expect_sound(const FactoredBtf& btf) {
  ASSERT_EQ(btf.pair_value.size(), btf.function_rows() * btf.components());
  ASSERT_EQ(ComponentRanges(btf).of(btf.layout.views().size() - 1).end, btf.components());
  if (btf.by_view()) {
    ASSERT_EQ(btf.view.size(), btf.components());
  }
  ASSERT_EQ(btf.levels.back().value.size(), btf.components());
}

void expect_sound(const SrbfBtf& btf) {
  for (const SrbfSide& side : btf.sides) {
    ASSERT_LE(side.tile_lobes, side.lobes.size());
    ASSERT_EQ(side.levels.back().value.size(), side.coefficients());
    for (const auto& axis : side.lobe) {
      for (const uint16_t lobe : axis) ASSERT_LT(lobe, side.lobes.size());
    }
  }
}

void expect_sound(const TensorBtf& btf) {
  for (const TensorSide& side : btf.sides) {
    ASSERT_EQ(side.levels.back().value.size(), side.members * side.rank.texel);
    for (const TensorLevel& level : side.levels) {
      for (const uint8_t member : level.member) ASSERT_LT(member, side.clusters.size());
    }
  }
}

TEST(HostileModel, DamagedFilesAreRefusedOrSound) {
  for (const Model& model : examples()) {
    const auto good = encode_model(model);
    for (uint64_t trial = 0; trial < 3000; ++trial) {
      auto bytes = good;
      RandomStream random(17, trial, 0);
      for (int i = 0; i < 4; ++i) bytes[random.next_bits() % bytes.size()] = static_cast<uint8_t>(random.next_bits());
      try {
        const auto damaged = std::make_shared<const Model>(decode_model(bytes, "damaged"));
        std::visit([](const auto& brdf) { expect_sound(brdf); }, damaged->body);
        make_material(damaged, 0);
      } catch (const Error&) {
      }
    }
  }
}

}  // namespace
}  // namespace velour::hostile_model_test
