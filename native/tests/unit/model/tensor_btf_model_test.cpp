#include <gtest/gtest.h>

#include <limits>

#include "btf/model/tensor_btf.h"
#include "unit/model/example_model.h"
#include "unit/model/refusals.h"

namespace velour::tensor_btf_model_test {
namespace {

using test::after_a_round_trip;
using test::set_value;

std::string tensor_refusal(const test::FileChange& change) {
  return test::refusal_of(test::example_tensor_model(true), change);
}

void expect_tensor_refused(const test::FileChange& change, const std::string& field) {
  test::expect_named(tensor_refusal(change), field);
}

void expect_same(const TensorBtfCluster& a, const TensorBtfCluster& b) {
  EXPECT_EQ(a.view, b.view);
  EXPECT_EQ(a.light, b.light);
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.core, b.core);
  ASSERT_EQ(a.scale.size(), b.scale.size());
  for (size_t r = 0; r < a.scale.size(); ++r) {
    EXPECT_EQ(a.scale[r].least, b.scale[r].least);
    EXPECT_EQ(a.scale[r].step, b.scale[r].step);
  }
}

void expect_same(const TensorSide& a, const TensorSide& b) {
  EXPECT_EQ(a.view_below, b.view_below);
  EXPECT_EQ(a.light_below, b.light_below);
  EXPECT_EQ(a.members, b.members);
  EXPECT_EQ(a.parameter_bytes(), b.parameter_bytes());
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  for (size_t c = 0; c < a.clusters.size(); ++c) expect_same(a.clusters[c], b.clusters[c]);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (size_t l = 0; l < a.levels.size(); ++l) {
    EXPECT_EQ(a.levels[l].relief, b.levels[l].relief);
    EXPECT_EQ(a.levels[l].member, b.levels[l].member);
    EXPECT_EQ(a.levels[l].value, b.levels[l].value);
  }
}

TEST(TensorBtfModel, SurvivesItsFile) {
  for (const bool two_sided : {false, true}) {
    const Model model = test::example_tensor_model(two_sided), back = after_a_round_trip(model);
    const auto &a = std::get<TensorBtf>(model.body), &b = std::get<TensorBtf>(back.body);
    EXPECT_STREQ(model_kind(back), "tensor-btf");
    EXPECT_TRUE(is_btf(back));
    EXPECT_EQ(grid_of(back)->width, 6u);
    EXPECT_EQ(a.layout, b.layout);
    EXPECT_EQ(a.grid, b.grid);
    EXPECT_EQ(a.companding, b.companding);
    EXPECT_EQ(a.axes, b.axes);
    ASSERT_EQ(a.sides.size(), b.sides.size());
    for (size_t s = 0; s < a.sides.size(); ++s) expect_same(a.sides[s], b.sides[s]);
    EXPECT_EQ(encode_model(model), encode_model(back));
    EXPECT_EQ(back.btf->method, "kcta");
  }
}

TEST(TensorBtfModel, PartsCostWhatTheyHold) {
  const TensorBtf btf = test::example_tensor();  // 3 clusters, 2 a texel, ranks 5, 4, 3, 2; 6 views and lights
  const TensorBytes bytes = bytes_of(btf.sides[0]);
  constexpr uint64_t kTexels = 6 * 4 + 3 * 2 + 1;
  EXPECT_EQ(bytes.coefficients, kTexels * 2 * 5);
  EXPECT_EQ(bytes.members, kTexels * 2);
  EXPECT_EQ(bytes.relief, kTexels * 2);
  EXPECT_EQ(bytes.factors, 3u * (6 * 4 + 6 * 3 + 3 * 2) * 2);
  EXPECT_EQ(bytes.cores, 3u * 5 * 4 * 3 * 2 * 2);
  EXPECT_EQ(bytes.scales, 3u * 5 * 8);
  EXPECT_EQ(btf.parameter_bytes(),
            bytes.coefficients + bytes.members + bytes.relief + bytes.factors + bytes.cores + bytes.scales);
}

TEST(TensorBtfModel, KeepsSidesThatAnotherOneServes) {
  Model model = test::example_tensor_model(true);
  auto& btf = std::get<TensorBtf>(model.body);
  btf.sides.pop_back();
  btf.shared = {{true, true, 0}};
  const Model back = after_a_round_trip(model);
  EXPECT_EQ(serving_side(std::get<TensorBtf>(back.body), true, true), 0u);
  EXPECT_EQ(encode_model(model), encode_model(back));
}

/// One of everything: a Tucker decomposition of rank 1.
TEST(TensorBtfModel, OfOneClusterOfRankOneSurvives) {
  Model model = test::example_tensor_model();
  model.body = test::example_tensor(false, Companding::none, {1, 1, {1, 1, 1, 1}, false});
  const Model back = after_a_round_trip(model);
  expect_same(std::get<TensorBtf>(back.body).sides[0], std::get<TensorBtf>(model.body).sides[0]);
}

TEST(TensorBtfModel, MissingOrMisshapenPartsAreNamed) {
  for (const char* part : {"btf.sides", "btf.axes", "btf.side.0.view", "btf.side.0.light", "btf.side.0.color",
                           "btf.side.0.core", "btf.side.0.scales", "btf.side.0.members.0", "btf.side.1.bytes.2"}) {
    expect_tensor_refused([part](TensorFile& f) { f.tensors.erase(part); }, part);
    expect_tensor_refused([part](TensorFile& f) { f.tensors[part] = {{3, 5}, std::vector<float>(15, 0.0f)}; }, part);
  }
  expect_tensor_refused(
      [](TensorFile& f) {
        f.tensors["btf.side.0.relief.0"] = {{3, 5}, std::vector<float>(15, 0.0f)};
      },
      "btf.side.0.relief.0");
}

TEST(TensorBtfModel, ALevelWithoutReliefIsAPlane) {
  EXPECT_EQ(tensor_refusal([](TensorFile& f) { f.tensors.erase("btf.side.0.relief.1"); }), "");
}

TEST(TensorBtfModel, LevelsHaveTheShapeOfTheTile) {
  for (const std::string part : {"relief", "members", "bytes"}) {
    const std::string name = "btf.side.0." + part + ".";
    expect_tensor_refused([&](TensorFile& f) { std::swap(f.tensors[name + "0"], f.tensors[name + "1"]); }, name + "0");
  }
}

TEST(TensorBtfModel, ValuesThatAreNoNumbersAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity}) {
    for (const char* part : {"view", "light", "color", "core", "scales", "members.0", "bytes.1", "relief.0"}) {
      const std::string name = std::string("btf.side.0.") + part;
      expect_tensor_refused(set_value(name, 3, bad), name + "[3]");
    }
  }
  expect_tensor_refused(set_value("btf.side.0.core", 5, 1e6f), "btf.side.0.core[5]");
  expect_tensor_refused(set_value("btf.side.0.scales", 3, -1e-3f), "btf.side.0.scales[3]");
  expect_tensor_refused(set_value("btf.side.1.bytes.0", 5, 0.5f / 256), "btf.side.1.bytes.0[5]");
}

TEST(TensorBtfModel, MembersAreClustersAndDiffer) {
  expect_tensor_refused(set_value("btf.side.0.members.0", 7, 3.0f / 256),
                        "btf.side.0.members.0[7]");  // there are three
  expect_tensor_refused(set_value("btf.side.0.members.0", 7, 255.0f / 256), "btf.side.0.members.0[7]");
  const auto same = [](TensorFile& f) {
    std::vector<float>& member = f.tensors.at("btf.side.0.members.0").data;
    member[24 + 5] = member[5];  // 24 texels
  };
  expect_tensor_refused(same, "btf.side.0.members.0[29]");
}

TEST(TensorBtfModel, MembersAreAtMostTheClusters) {
  expect_tensor_refused(
      [](TensorFile& f) {
        f.tensors["btf.side.0.members.0"] = {{4, 4, 6}, std::vector<float>(96)};
      },
      "btf.side.0.members.0");
}

TEST(TensorBtfModel, RanksHaveLimits) {
  const auto core = [](uint64_t clusters, uint64_t rank) {
    return [=](TensorFile& f) {
      f.tensors["btf.side.0.core"] = {{clusters, rank, 1}, std::vector<float>(clusters * rank)};
    };
  };
  expect_tensor_refused(core(257, 1), "257 entries along dimension 0");
  expect_tensor_refused(core(1, 257), "257 entries along dimension 1");
  expect_tensor_refused(core(200, 17), "200 clusters of rank 17");
  expect_tensor_refused(
      [](TensorFile& f) {
        f.tensors["btf.side.0.color"] = {{3, 3, 4}, std::vector<float>(36)};
      },
      "btf.side.0.color");
}

TEST(TensorBtfModel, SidesAreWhereDirectionsAre) {
  const Model one = test::example_tensor_model(false);
  test::expect_named(test::refusal_of(one, set_value("btf.sides", 0, 1)), "btf.sides");
  test::expect_named(test::refusal_of(one, set_value("btf.sides", 1, 1)), "btf.sides");
  expect_tensor_refused([](TensorFile& f) { f.tensors["btf.sides"] = {{3, 2}, {0, 0, 0, 1, 1, 0}}; }, "btf.side.2");
}

TEST(TensorBtfModel, NothingOutsideTheTableMatters) {
  EXPECT_EQ(tensor_refusal([](TensorFile& f) { f.tensors["btf.side.7.core"] = {{1}, {1}}; }), "");
  EXPECT_EQ(tensor_refusal([](TensorFile&) {}), "");
}

}  // namespace
}  // namespace velour::tensor_btf_model_test
