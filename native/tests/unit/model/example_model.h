// Small models with every field set to something that is not its default.
#pragma once

#include <cmath>

#include "image/tensors/exr_tensors.h"
#include "math/sphere/directions.h"
#include "model/model.h"
#include "support/example_btf.h"
#include "support/example_srbf.h"
#include "support/example_tensor.h"

namespace velour::test {

/// A record without body.
inline Model example_record() {
  Model model;
  model.fit = {.relative_l2 = 1.0 / 3.0,
               .by_view_angle = {{"5", 0.01}, {"30", 0.02}, {"60", 0.03}, {"75", std::nullopt}, {"85", std::nullopt}},
               .albedo_by_view_angle = {{"5", 0.4}, {"30", std::nullopt}},
               .albedo_max = 0.7,
               .reciprocity = 0.05,
               .measured_reciprocity = 0.125,
               .tolerance = 0.02,
               .seed = 12345678901234567ull,
               .all_data = true,
               .order = {},
               .warnings = {warning<WarningCode::stored_sentence>({{"text", "\"quoted\" and accented: \xc3\xa9"}}),
                            warning<WarningCode::views_exceed_tolerance>({{"views", std::vector<double>{60}},
                                                                          {"errors", std::vector<double>{0.03}},
                                                                          {"tolerance", 0.02}})},
               .verdict = Verdict{LookQuality::fair, 0.0625, 0.125, LookReason::brightness, 1.25}};
  model.fit.order.points = {{1, 52, 12.5, 0.25}, {2, 80, 2.125, 0.0425}, {4, 136, 0.875, 0.0175}};
  model.fit.order.chosen = 2;
  model.source = {"metal", "merl", std::string(64, 'a')};
  return model;
}

inline Model example_model(Kernel kernel = Kernel::gaussian, bool isotropic = true) {
  PerViewBrdf brdf;
  brdf.kernel = kernel;
  brdf.isotropic = isotropic;
  brdf.align_views = false;
  brdf.default_neighbors = isotropic ? 2 : 4;
  brdf.first_lobe.push_back(0);
  for (int i = 0; i < 5; ++i) {
    const float theta = 0.3f * static_cast<float>(i);
    brdf.views.push_back(direction(theta, isotropic ? 0.0f : static_cast<float>(i)));
    brdf.diffuse.emplace_back(0.1f, 0.01f * static_cast<float>(i), 0.0f);
    for (int j = 0; j < i; ++j) {  // the first view has no lobe
      brdf.center.push_back(direction(0.2f * static_cast<float>(j), theta));
      brdf.bandwidth.push_back(kernel == Kernel::gaussian ? 3.0f * static_cast<float>(j + 1)
                                                          : 0.2f + 0.1f * static_cast<float>(j));
      brdf.coefficient.emplace_back(0.5f, static_cast<float>(j), 1.0f / 3.0f);
    }
    brdf.first_lobe.push_back(static_cast<uint32_t>(brdf.center.size()));
  }
  Model model = example_record();
  model.body = brdf;
  return model;
}

/// Lobes of both spaces, control values all over their ranges.
inline Model example_parametric(bool isotropic = true, int lobes = 5, int cells = 10, const ViewRange& views = {}) {
  ParametricBrdf brdf;
  brdf.isotropic = isotropic;
  brdf.cells = cells;
  brdf.views = views;
  for (int j = 0; j < lobes; ++j) brdf.space.push_back(j % 2 == 0 ? LobeSpace::half : LobeSpace::light);
  brdf.control.resize(static_cast<size_t>(brdf.spline().node_count() * brdf.parameter_count() * lobes));
  for (size_t i = 0; i < brdf.control.size(); ++i) {
    brdf.control[i] = rounded_to_half(2.5f * std::sin(static_cast<float>(i * i)));
  }
  Model model = example_record();
  model.body = brdf;
  return model;
}

/// Seen at 31 to 48 degrees in two frames.
inline Model example_reduced() {
  Model model = example_parametric(true, 3, 2, {30, 49});
  SceneRecord& scene = model.scene.emplace();
  for (size_t i = 31; i < 48; ++i) scene.domain.view[i] = static_cast<double>(i * i);
  scene.domain.camera_rays = 131072;
  scene.domain.frames = 2;
  scene.domain.light_density = 3.25;
  scene.domain.hash = {1, 0x0123456789abcdefULL, 0, ~uint64_t{0}};
  scene.picture_error = 1.0 / 3.0e6;
  scene.full_picture_error = 1.0 / 7.0e6;
  scene.full_parameter_bytes = 931;
  return model;
}

inline Model example_btf_model(bool two_sided = false) {
  Model model{example_factored(two_sided), {}, {"weave", "velour-btf", std::string(64, 'b')}};
  model.btf = BtfRecord{"svd", 23.5, 21.25, 0.01, 0.5, 123456, 1.5, 2e6, 42, {}, 0.125, 0.25, {}, {}, {}};
  model.btf->warnings = {warning<WarningCode::values_not_finite>({{"values", uint64_t{12}}})};
  model.btf->order = {{{1, 100, 1.5, 0.375}, {3, 300, 0.5, 0.125}}, 1};
  model.btf->search = {{3, 300, 0.25, 0.125}};
  return model;
}

inline Model example_view_svd_model() {
  Model model = example_btf_model();
  model.body = example_factored(false, Companding::root, true);
  model.btf->method = "svd-view";
  return model;
}

inline Model example_srbf_model(bool two_sided = false) {
  Model model{example_srbf(two_sided), {}, {"gravel", "velour-btf", std::string(64, 'c')}};
  model.btf = BtfRecord{"srbf", 24.5, std::nullopt, 0.02, 0.25, 654321, 2.5, 3e6, 7, {}, 0, 0, {}, {}, {}};
  return model;
}

inline Model example_tensor_model(bool two_sided = false) {
  Model model{example_tensor(two_sided), {}, {"net", "velour-btf", std::string(64, 'd')}};
  model.btf = BtfRecord{"kcta", 25.5, 24.5, 0.03, 0.75, 765432, 3.5, 4e6, 9, {}, 0.25, 0, {}, {}, {}};
  return model;
}

}  // namespace velour::test
