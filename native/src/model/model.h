// The fitted, immutable asset: parameters, error against its source, where it came from; and its run-time evaluator.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>
#include "base/warning.h"
#include "brdf/measure/measurement.h"
#include "brdf/model/parametric_brdf.h"
#include "brdf/model/per_view_brdf.h"
#include "btf/model/factored_btf.h"
#include "btf/model/srbf_btf.h"
#include "btf/model/tensor_btf.h"
#include "material/material.h"
#include "model/records.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

/// Relative L2 error by view angle; keys "5", "30", "60", "75", "85" (degrees), nullopt where not covered.
using ErrorByViewAngle = std::map<std::string, std::optional<double>>;

/// Results of the fit; stored in the model file and shown with the material.
struct FitRecord {
  double relative_l2 = 0;  // mean over views weighted by cos(theta_v)
  ErrorByViewAngle by_view_angle;
  ErrorByViewAngle albedo_by_view_angle;                      // directional albedo (largest channel) at those views
  double albedo_max = 0;                                      // over all fitted views, largest channel
  double reciprocity = 0;                                     // of the model: brdf/fit/fit_report.h
  std::optional<double> measured_reciprocity = std::nullopt;  // of the measurement, if it covers pairs both ways
  double tolerance = 0;
  double seconds = 0;  // wall clock of the fit
  uint64_t seed = 0;
  bool all_data = false;  // fitted without held-out data
  OrderCurve order;
  std::vector<Warning> warnings;
  std::optional<Verdict> verdict = std::nullopt;  // none: not judged (verdict/verdict.h)
};

/// The data that the model was fitted to.
struct SourceRecord {
  std::string name, format, sha256;
};

/// Kinds of model. Append new kinds at the end.
using ModelBody = std::variant<PerViewBrdf, ParametricBrdf, FactoredBtf, SrbfBtf, TensorBtf>;

/// The silhouette (VOTF) of the structure over a material's surfaces.
struct ModelShell {
  std::shared_ptr<const VotfVolume> volume;
  std::string source;                               // name of what was captured
  std::optional<VotfErrors> errors = std::nullopt;  // none: not measured
};

struct Model {
  ModelBody body;
  FitRecord fit;
  SourceRecord source;
  /// Set for a model reduced to scene usage. The body holds the views that it covers.
  std::optional<SceneRecord> scene = std::nullopt;
  /// Set for a BTF; `fit` is then empty.
  std::optional<BtfRecord> btf = std::nullopt;
  std::optional<ModelShell> shell = std::nullopt;
};

uint64_t parameter_bytes(const ModelBody& body);

/// Whether the model is valid for some scenes only. A model fitted for scenes that need all of the full model is the
/// full model, and valid for any scene.
bool is_reduced(const Model& model);

/// Whether the model is of a BTF, with a BtfRecord, rather than of a BRDF.
bool is_btf(const Model& model);

/// Bodies of BTF models.
template <typename Body>
concept BtfBody = requires(const Body& body) {
  body.layout;
  body.grid;
  body.companding;
};

/// Calls `use` with the body of a BTF model of any kind. Throws std::bad_variant_access for a BRDF model.
template <typename Use>
auto with_btf(const ModelBody& body, const Use& use) {
  using Result = decltype(use(std::get<FactoredBtf>(body)));
  return std::visit(
      [&]<typename Body>(const Body& b) -> Result {
        if constexpr (BtfBody<Body>) {
          return use(b);
        } else {
          throw std::bad_variant_access();
        }
      },
      body);
}

/// The texel grid of a BTF model; null for a BRDF model.
const TexelGrid* grid_of(const Model& model);

/// "scattered", "parametric", "factored-btf", "srbf-btf", "tensor-btf".
const char* model_kind(const Model& model);

// Makes the run-time evaluator of a model.

/// f and samples of the model, whose ownership it shares. `neighbors`: number of views mixed for a per-view model, 0:
/// the model's default.
std::shared_ptr<const Material> make_material(const std::shared_ptr<const Model>& model, int neighbors);

/// make_material() for light from the viewer's side only, without the transmission of a BTF.
std::shared_ptr<const Material> make_reflecting_material(const std::shared_ptr<const Model>& model, int neighbors);

/// Reference mode: f of the measurement, samples of the model, unbiased whatever the model's error.
std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const Model>& proposal, int neighbors);

}  // namespace velour
