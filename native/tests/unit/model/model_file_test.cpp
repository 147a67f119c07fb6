#include "model/model_file.h"

#include <gtest/gtest.h>

#include "brdf/scattered_brdf.h"
#include "example_model.h"
#include "file/file.h"
#include "job/error.h"
#include "support/test_data.h"

namespace velour {
namespace {

using test::example_model;

const ScatteredBrdf& body(const Model& model) { return std::get<ScatteredBrdf>(model.body); }

void expect_equal(const Model& a, const Model& b) {
  EXPECT_EQ(body(a).kernel, body(b).kernel);
  EXPECT_EQ(body(a).isotropic, body(b).isotropic);
  EXPECT_EQ(body(a).align_views, body(b).align_views);
  EXPECT_EQ(body(a).default_neighbors, body(b).default_neighbors);
  EXPECT_EQ(body(a).views, body(b).views);
  EXPECT_EQ(body(a).diffuse, body(b).diffuse);
  EXPECT_EQ(body(a).first_lobe, body(b).first_lobe);
  EXPECT_EQ(body(a).center, body(b).center);
  EXPECT_EQ(body(a).bandwidth, body(b).bandwidth);
  EXPECT_EQ(body(a).coefficient, body(b).coefficient);
  EXPECT_EQ(a.fit.relative_l2, b.fit.relative_l2);
  EXPECT_EQ(a.fit.by_view_angle, b.fit.by_view_angle);
  EXPECT_EQ(a.fit.albedo_by_view_angle, b.fit.albedo_by_view_angle);
  EXPECT_EQ(a.fit.albedo_max, b.fit.albedo_max);
  EXPECT_EQ(a.fit.reciprocity, b.fit.reciprocity);
  EXPECT_EQ(a.fit.measured_reciprocity, b.fit.measured_reciprocity);
  EXPECT_EQ(a.fit.tolerance, b.fit.tolerance);
  EXPECT_EQ(a.fit.seconds, b.fit.seconds);
  EXPECT_EQ(a.fit.seed, b.fit.seed);
  EXPECT_EQ(a.fit.all_data, b.fit.all_data);
  EXPECT_EQ(a.fit.warnings, b.fit.warnings);
  EXPECT_EQ(a.source.name, b.source.name);
  EXPECT_EQ(a.source.format, b.source.format);
  EXPECT_EQ(a.source.sha256, b.source.sha256);
}

TEST(ModelFile, RoundTripKeepsEveryBit) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    for (const bool isotropic : {true, false}) {
      const Model model = example_model(kernel, isotropic);
      const auto bytes = encode_model(model);
      const Model again = decode_model(bytes, "memory");
      expect_equal(model, again);
      EXPECT_EQ(encode_model(again), bytes);
    }
  }
}

TEST(ModelFile, ABlackModelHasNoLobes) {
  Model black = example_model();
  auto& brdf = std::get<ScatteredBrdf>(black.body);
  brdf.center.clear();
  brdf.bandwidth.clear();
  brdf.coefficient.clear();
  brdf.diffuse.clear();
  brdf.first_lobe.assign(brdf.views.size() + 1, 0);
  expect_equal(black, decode_model(encode_model(black), "memory"));
}

TEST(ModelFile, SavesAndLoads) {
  const std::string path = test::scratch_folder() / "metal.velour";
  save_model(example_model(), path);
  EXPECT_TRUE(is_model_file(path));
  expect_equal(load_model(path), example_model());
}

TEST(ModelFile, OtherFilesAreNoModels) {
  const std::string path = test::scratch_folder() / "other";
  const std::string text = "velour.kind model";
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  EXPECT_FALSE(is_model_file(path));
  EXPECT_THROW(load_model(path), Error);
}

TEST(ModelFile, OverheadIsAFewKilobytes) {
  const Model model = example_model();
  EXPECT_LT(encode_model(model).size(), body(model).parameter_bytes() + 5000);
}

TEST(ModelFile, AMaterialSharesTheModel) {
  const auto model = std::make_shared<const Model>(example_model());
  const auto material = make_material(model, 0);
  EXPECT_TRUE(material->isotropic());
  EXPECT_EQ(std::string(model_kind(*model)), "scattered");
}

}  // namespace
}  // namespace velour
