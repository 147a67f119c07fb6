#include <gtest/gtest.h>

#include <limits>

#include "unit/model/example_model.h"
#include "unit/model/refusals.h"

namespace velour::srbf_btf_model_test {
namespace {

using test::after_a_round_trip;
using test::set_value;

/// What is said to a model of two sides after `change`.
std::string srbf_refusal(const test::FileChange& change) {
  return test::refusal_of(test::example_srbf_model(true), change);
}

void expect_srbf_refused(const test::FileChange& change, const std::string& field) {
  test::expect_named(srbf_refusal(change), field);
}

TEST(SrbfBtfModel, SurvivesItsFile) {
  for (const bool two_sided : {false, true}) {
    const Model model = test::example_srbf_model(two_sided), back = after_a_round_trip(model);
    const auto &a = std::get<SrbfBtf>(model.body), &b = std::get<SrbfBtf>(back.body);
    EXPECT_STREQ(model_kind(back), "srbf-btf");
    EXPECT_EQ(a.layout, b.layout);
    EXPECT_EQ(a.grid, b.grid);
    EXPECT_EQ(a.companding, b.companding);
    EXPECT_EQ(a.axes, b.axes);
    ASSERT_EQ(a.sides.size(), b.sides.size());
    for (size_t s = 0; s < a.sides.size(); ++s) {
      const SrbfSide &one = a.sides[s], &two = b.sides[s];
      EXPECT_EQ(one.view_below, two.view_below);
      EXPECT_EQ(one.light_below, two.light_below);
      EXPECT_EQ(one.tile_lobes, two.tile_lobes);
      EXPECT_EQ(one.lobe, two.lobe);
      ASSERT_EQ(one.lobes.size(), two.lobes.size());
      for (size_t j = 0; j < one.lobes.size(); ++j) {
        EXPECT_EQ(one.lobes[j].light, two.lobes[j].light);
        EXPECT_EQ(one.lobes[j].view, two.lobes[j].view);
        EXPECT_EQ(one.lobes[j].half, two.lobes[j].half);
      }
      ASSERT_EQ(one.levels.size(), two.levels.size());
      for (size_t l = 0; l < one.levels.size(); ++l) {
        EXPECT_EQ(one.levels[l].relief, two.levels[l].relief);
        EXPECT_EQ(one.levels[l].value, two.levels[l].value);
      }
    }
    EXPECT_EQ(encode_model(model), encode_model(back));
  }
}

TEST(SrbfBtfModel, KeepsItsRecord) {
  const BtfRecord record = *after_a_round_trip(test::example_srbf_model()).btf;
  EXPECT_EQ(record.method, "srbf");
  EXPECT_EQ(record.psnr_held_out, std::nullopt);
}

TEST(SrbfBtfModel, KeepsSidesThatAnotherOneServes) {
  Model model = test::example_srbf_model();
  SrbfBtf btf = test::example_srbf(true);
  btf.sides.pop_back();
  btf.shared = {{true, true, 0}};
  model.body = btf;
  const Model back = after_a_round_trip(model);
  const std::vector<SharedSide>& shared = std::get<SrbfBtf>(back.body).shared;
  ASSERT_EQ(shared.size(), 1u);
  EXPECT_TRUE(shared[0].view_below && shared[0].light_below);
  EXPECT_EQ(shared[0].side, 0u);
  EXPECT_EQ(encode_model(model), encode_model(back));
}

TEST(SrbfBtfModel, SharedSidesNameSidesThatAreThere) {
  const auto shared = [](std::vector<float> row) {
    return [row](TensorFile& f) { f.tensors["btf.shared"] = {{row.size() / 3, 3}, row}; };
  };
  expect_srbf_refused(shared({1, 0, 2}), "btf.shared[2]");  // of two
  expect_srbf_refused(shared({1, 0, 0.5f}), "btf.shared[2]");
  expect_srbf_refused(shared({2, 0, 0}), "btf.shared[0]");
  expect_srbf_refused(shared(std::vector<float>(12, 0.0f)), "btf.shared");
}

TEST(SrbfBtfModel, OfOneBlackLobeSurvives) {
  SrbfBtf btf = test::example_srbf();
  SrbfSide& side = btf.sides[0];
  side.lobes.resize(1);
  side.tile_lobes = 1;
  side.lobe = {{{0}, {}, {}}};
  side.scale = {{0, 0}};
  for (SrbfLevel& level : side.levels) level.value.assign(size_t{level.width} * level.height, 0);
  Model model = test::example_srbf_model();
  model.body = btf;
  const Model back = after_a_round_trip(model);
  EXPECT_EQ(std::get<SrbfBtf>(back.body).sides[0].coefficients(), 1u);
}

TEST(SrbfBtfModel, MissingOrMisshapenPartsAreNamed) {
  for (const char* part : {"btf.sides", "btf.axes", "btf.side.0.lobes", "btf.side.0.frames", "btf.side.0.coefficients",
                           "btf.side.0.scales", "btf.side.1.relief.0", "btf.side.1.bytes.2"}) {
    expect_srbf_refused([part](TensorFile& f) { f.tensors.erase(part); }, part);
    expect_srbf_refused([part](TensorFile& f) { f.tensors[part] = {{3, 5}, std::vector<float>(15, 0.0f)}; }, part);
  }
  for (const char* key : {"velour.btf.index", "velour.companding", "velour.btf.record"}) {
    expect_srbf_refused([key](TensorFile& f) { f.attributes.erase(key); }, key);
    expect_srbf_refused([key](TensorFile& f) { f.attributes[key] = "nonsense"; }, key);
  }
}

TEST(SrbfBtfModel, LevelsHaveTheShapeOfTheTile) {
  expect_srbf_refused(
      [](TensorFile& f) { std::swap(f.tensors["btf.side.0.relief.0"], f.tensors["btf.side.0.relief.1"]); },
      "btf.side.0.relief.0");
  expect_srbf_refused(
      [](TensorFile& f) { std::swap(f.tensors["btf.side.0.bytes.0"], f.tensors["btf.side.0.bytes.1"]); },
      "btf.side.0.bytes.0");
}

TEST(SrbfBtfModel, ValuesThatAreNoNumbersAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity}) {
    expect_srbf_refused(set_value("btf.side.0.lobes", 10, bad), "btf.side.0.lobes[10]");
    expect_srbf_refused(set_value("btf.side.0.frames", 2, bad), "btf.side.0.frames[2]");
    expect_srbf_refused(set_value("btf.side.0.coefficients", 3, bad), "btf.side.0.coefficients[3]");
    expect_srbf_refused(set_value("btf.side.1.relief.0", 7, bad), "btf.side.1.relief.0[7]");
    expect_srbf_refused(set_value("btf.side.1.scales", 4, bad), "btf.side.1.scales[4]");
    expect_srbf_refused(set_value("btf.side.1.scales", 5, bad), "btf.side.1.scales[5]");
    expect_srbf_refused(set_value("btf.side.1.bytes.1", 9, bad), "btf.side.1.bytes.1[9]");
    expect_srbf_refused(set_value("btf.sides", 1, bad), "btf.sides[1]");
    expect_srbf_refused(set_value("btf.axes", 4, bad), "btf.axes[4]");
  }
  expect_srbf_refused(set_value("btf.side.0.lobes", 10, 2e6f), "btf.side.0.lobes[10]");
}

TEST(SrbfBtfModel, FiniteValuesThatNoHalfFloatHoldsAreNamed) {
  expect_srbf_refused(set_value("btf.side.0.relief.0", 3, 1e6f), "btf.side.0.relief.0[3]");
  expect_srbf_refused(set_value("btf.side.0.scales", 2, -1e11f), "btf.side.0.scales[2]");
  expect_srbf_refused(set_value("btf.side.0.scales", 3, -1e-3f), "btf.side.0.scales[3]");
}

TEST(SrbfBtfModel, ValuesThatAreNoBytesAreNamed) {
  for (const float bad : {-1.0f / 256, 1.0f, 0.5f / 256}) {
    expect_srbf_refused(set_value("btf.side.1.bytes.0", 5, bad), "btf.side.1.bytes.0[5]");
  }
}

/// As 1.4 wrote it: half floats, without scales.
TensorFile older_file(const SrbfBtf& btf) {
  Model model = test::example_srbf_model();
  model.body = btf;
  TensorFile file = decode_tensors(encode_model(model), "test.velour");
  file.packed = false;
  file.attributes["velour.format_version"] = "1.4";
  file.tensors.erase("btf.side.0.scales");
  const std::vector<ByteScale>& scale = btf.sides[0].scale;
  for (size_t l = 0; l < btf.sides[0].levels.size(); ++l) {
    const std::string number = std::to_string(l);
    Tensor tensor = file.tensors.at("btf.side.0.bytes." + number);
    tensor.precision = Precision::halves;
    const size_t texels = tensor.data.size() / scale.size();
    for (size_t i = 0; i < tensor.data.size(); ++i) {
      const ByteScale& s = scale[i / texels];
      tensor.data[i] = rounded_to_half(s.least + s.step * 256 * tensor.data[i]);
    }
    file.tensors.erase("btf.side.0.bytes." + number);
    file.tensors["btf.side.0.texels." + number] = tensor;
  }
  return file;
}

TEST(SrbfBtfModel, OfTheVersionBeforeIsReadWithinHalfAStep) {
  const SrbfBtf btf = test::example_srbf();
  const TensorFile file = older_file(btf);
  const SrbfSide& then = btf.sides[0];
  const Model back = decode_model(encode_tensors(file), "test.velour");
  const SrbfSide& now = std::get<SrbfBtf>(back.body).sides[0];
  ASSERT_EQ(now.levels.size(), then.levels.size());
  const size_t count = then.coefficients();
  for (size_t l = 0; l < then.levels.size(); ++l) {
    ASSERT_EQ(now.levels[l].value.size(), then.levels[l].value.size());
    for (size_t i = 0; i < then.levels[l].value.size(); ++i) {
      const ByteScale &a = then.scale[i % count], &b = now.scale[i % count];
      const float before = a.least + a.step * then.levels[l].value[i];
      EXPECT_NEAR(b.least + b.step * now.levels[l].value[i], before, 0.51f * b.step + 3e-4f);
    }
  }
}

TEST(SrbfBtfModel, OfTheVersionBeforePacksIsRead) {
  const SrbfBtf btf = test::example_srbf();
  Model model = test::example_srbf_model();
  model.body = btf;
  TensorFile file = decode_tensors(encode_model(model), "test.velour");
  file.packed = false;
  for (auto& [name, tensor] : file.tensors) {
    if (tensor.precision == Precision::bytes) tensor.precision = Precision::halves;
  }
  const Model back = decode_model(encode_tensors(file), "test.velour");
  EXPECT_EQ(encode_model(back), encode_model(model));
}

TEST(SrbfBtfModel, OfTheVersionBeforeNamesValuesThatAreNoNumbers) {
  TensorFile file = older_file(test::example_srbf());
  file.tensors.at("btf.side.0.texels.1").precision = Precision::floats;
  file.tensors.at("btf.side.0.texels.1").data[3] = std::numeric_limits<float>::infinity();
  try {
    decode_model(encode_tensors(file), "test.velour");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("btf.side.0.texels.1[3]"), std::string::npos) << error.what();
  }
}

TEST(SrbfBtfModel, FramesAreThoseOfTheTileFirst) {
  expect_srbf_refused(set_value("btf.side.0.frames", 1, 0.5f), "btf.side.0.frames[1]");
  expect_srbf_refused(set_value("btf.side.0.frames", 0, 1), "btf.side.0.frames[1]");
  expect_srbf_refused(set_value("btf.side.0.frames", 4, 0), "btf.side.0.frames[4]");
}

/// Rows of (axis, lobe): five of axis 0, two of axis 1, one of axis 2.
TEST(SrbfBtfModel, CoefficientsNameAxesAndLobes) {
  const char part[] = "btf.side.0.coefficients";
  expect_srbf_refused(set_value(part, 12, 3), "btf.side.0.coefficients[12]");
  expect_srbf_refused(set_value(part, 12, -1), "btf.side.0.coefficients[12]");
  expect_srbf_refused(set_value(part, 12, 1.5f), "btf.side.0.coefficients[12]");
  expect_srbf_refused(set_value(part, 12, 0), "btf.side.0.coefficients[12]");  // falls back
  expect_srbf_refused(set_value(part, 11, 5), "btf.side.0.coefficients[11]");  // there are five lobes
  expect_srbf_refused(set_value(part, 11, -1), "btf.side.0.coefficients[11]");
  expect_srbf_refused(set_value(part, 11, 0.5f), "btf.side.0.coefficients[11]");
  expect_srbf_refused(set_value(part, 3, 0), "btf.side.0.coefficients[3]");  // axis 0 has all lobes in order
  expect_srbf_refused(set_value(part, 8, 1), "btf.side.0.coefficients");     // the last lobe of axis 0 is gone
}

TEST(SrbfBtfModel, SidesAreAtMostFourOfTwoBits) {
  expect_srbf_refused(set_value("btf.sides", 3, 2), "btf.sides[3]");
  expect_srbf_refused(
      [](TensorFile& f) {
        f.tensors["btf.sides"] = {{5, 2}, std::vector<float>(10, 0.0f)};
      },
      "btf.sides");
  expect_srbf_refused([](TensorFile& f) { f.tensors["btf.sides"] = {{3, 2}, {0, 0, 0, 1, 1, 0}}; }, "btf.side.2");
}

TEST(SrbfBtfModel, OfVersionsBeforeTheNextHasLobesWithoutAPhase) {
  SrbfBtf btf = test::example_srbf();
  Model model = test::example_srbf_model();
  model.body = btf;
  TensorFile file = decode_tensors(encode_model(model), "test.velour");
  Tensor& lobes = file.tensors.at("btf.side.0.lobes");
  ASSERT_EQ(lobes.shape[1], 10u);
  Tensor before{{lobes.shape[0], 9}, {}};
  for (size_t i = 0; i < lobes.data.size(); ++i) {
    if (i % 10 != 9) before.data.push_back(lobes.data[i]);
  }
  lobes = before;
  const Model back = decode_model(encode_tensors(file), "test.velour");
  const std::vector<MultivariateLobe>& read = std::get<SrbfBtf>(back.body).sides[0].lobes;
  ASSERT_EQ(read.size(), btf.sides[0].lobes.size());
  for (size_t j = 0; j < read.size(); ++j) {
    EXPECT_EQ(read[j].phase, 0.0f);
    EXPECT_EQ(read[j].light, btf.sides[0].lobes[j].light);
    EXPECT_EQ(read[j].half, btf.sides[0].lobes[j].half);
  }
}

TEST(SrbfBtfModel, LobesAreAtMostTheirLimit) {
  expect_srbf_refused(
      [](TensorFile& f) {
        f.tensors["btf.side.0.lobes"] = {{257, 9}, std::vector<float>(257 * 9)};
      },
      "257 lobes");
}

TEST(SrbfBtfModel, NothingOutsideTheTableMatters) {
  EXPECT_EQ(srbf_refusal([](TensorFile& f) { f.tensors["btf.side.7.lobes"] = {{1}, {1}}; }), "");
  EXPECT_EQ(srbf_refusal([](TensorFile&) {}), "");
}

}  // namespace
}  // namespace velour::srbf_btf_model_test
