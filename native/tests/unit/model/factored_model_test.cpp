#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "image/tensors/exr_tensors.h"
#include "model/file/model_file.h"
#include "support/warnings.h"
#include "unit/model/example_model.h"
#include "unit/model/refusals.h"

namespace velour::factored_model_test {
namespace {

using test::after_a_round_trip;

/// The sentence that refuses a model after `change`.
template <class Change>
std::string refusal(const Change& change, const Model& model = test::example_btf_model()) {
  TensorFile file = decode_tensors(encode_model(model), "test.velour");
  change(file);
  try {
    decode_model(encode_tensors(file), "test.velour");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FactoredModel, SurvivesItsFile) {
  for (const bool two_sided : {false, true}) {
    const Model model = test::example_btf_model(two_sided), back = after_a_round_trip(model);
    const auto &a = std::get<FactoredBtf>(model.body), &b = std::get<FactoredBtf>(back.body);
    EXPECT_STREQ(model_kind(back), "factored-btf");
    EXPECT_EQ(a.layout, b.layout);
    EXPECT_EQ(a.grid, b.grid);
    EXPECT_EQ(a.companding, b.companding);
    EXPECT_EQ(a.axes, b.axes);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.pair_value, b.pair_value);
    ASSERT_EQ(a.levels.size(), b.levels.size());
    for (size_t l = 0; l < a.levels.size(); ++l) EXPECT_EQ(a.levels[l].value, b.levels[l].value);
    EXPECT_EQ(encode_model(model), encode_model(back));
  }
}

TEST(FactoredModel, OfViewsSurvivesItsFile) {
  const Model model = test::example_view_svd_model(), back = after_a_round_trip(model);
  const auto &a = std::get<FactoredBtf>(model.body), &b = std::get<FactoredBtf>(back.body);
  EXPECT_TRUE(b.by_view());
  EXPECT_EQ(a.view, b.view);
  EXPECT_EQ(a.axis, b.axis);
  EXPECT_EQ(a.pair_value, b.pair_value);
  EXPECT_EQ(a.levels[0].value, b.levels[0].value);
  EXPECT_EQ(encode_model(model), encode_model(back));
}

TEST(FactoredModel, OfViewsRefusesADamagedFileByItsField) {
  const auto complaint = [](const auto& change) { return refusal(change, test::example_view_svd_model()); };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_EQ(complaint([](TensorFile&) {}), "");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors["btf.view"].data[3] = 0; }), "btf.view[3]");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors["btf.view"].data[0] = 0.5f; }), "btf.view[0]");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors["btf.view"].data[10] = 6; }), "btf.view[10]");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors["btf.axis"].data[1] = 3; }), "btf.axis[1]");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors["btf.axis"] = {{2}, {0, 1}}; }), "btf.axis");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors.erase("btf.lights"); }), "btf.lights");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors["btf.lights"].shape = {11, 6}; }), "btf.lights");
  EXPECT_PRED2(has, complaint([](TensorFile& f) { f.tensors.erase("btf.view"); }), "btf.axis[1]");
  EXPECT_PRED2(has, complaint([](TensorFile& f) {
                 f.tensors["btf.view"] = {{200}, std::vector<float>(200)};
               }),
               "btf.view[160]");
}

TEST(FactoredModel, KeepsItsRecord) {
  Model model = test::example_btf_model();
  model.btf->verdict = Verdict{LookQuality::fair, 0.0625, 0.25, LookReason::grazing_views, 60};
  const BtfRecord written = *model.btf;
  const BtfRecord record = *after_a_round_trip(model).btf;
  EXPECT_EQ(record.verdict, written.verdict);
  EXPECT_EQ(record.relative_l2, written.relative_l2);
  EXPECT_EQ(record.tolerance, written.tolerance);
  EXPECT_EQ(record.order, written.order);
  EXPECT_EQ(record.search, written.search);
  EXPECT_EQ(record.method, "svd");
  EXPECT_EQ(record.psnr, 23.5);
  EXPECT_EQ(record.psnr_held_out, 21.25);
  EXPECT_EQ(record.p99, 0.5);
  EXPECT_EQ(record.raw_bytes, 123456u);
  EXPECT_EQ(record.seed, 42u);
  EXPECT_EQ(record.warnings, written.warnings);
}

TEST(FactoredModel, RefusesADamagedFileByItsField) {
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.attributes["velour.companding"] = "cube"; }), "velour.companding");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.attributes["velour.btf.index"] = "{}"; }), "velour.btf.index");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.attributes.erase("velour.btf.record"); }), "velour.btf.record");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.attributes["velour.btf.record"] = "[1]"; }), "velour.btf.record");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.tensors.erase("btf.texels.1"); }), "btf.texels.1");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.tensors["btf.pairs"].shape = {5, 42}; }), "btf.pairs");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.tensors["btf.axis"].data[1] = 3; }), "btf.axis[1]");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.tensors["btf.axis"].data[4] = 0; }), "btf.axis[4]");
  EXPECT_PRED2(has, refusal([](TensorFile& f) { f.tensors["btf.axes"].data[2] = 7; }), "btf.axes[2]");
  EXPECT_PRED2(
      has, refusal([](TensorFile& f) { f.tensors["btf.texels.0"].data[9] = std::numeric_limits<float>::infinity(); }),
      "btf.texels.0[9]");
}

}  // namespace
}  // namespace velour::factored_model_test
