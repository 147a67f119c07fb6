// The fitted, immutable asset: parameters, error against its source, and where it came from.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "brdf/parametric_brdf.h"
#include "brdf/scattered_brdf.h"
#include "btf/factored_btf.h"
#include "btf/srbf_btf.h"
#include "btf/tensor_btf.h"
#include "model/btf_record.h"
#include "model/order_curve.h"
#include "model/scene_record.h"
#include "votf/occlusion_volume.h"

namespace velour {

/// Relative L2 error by view angle; keys "5", "30", "60", "75", "85" (degrees), nullopt where not covered.
using ErrorByViewAngle = std::map<std::string, std::optional<double>>;

/// What the fit found out; stored in the model file and shown beside the material.
struct FitRecord {
  double relative_l2 = 0;  // mean over views weighted by cos(theta_v)
  ErrorByViewAngle by_view_angle;
  ErrorByViewAngle albedo_by_view_angle;                      // directional albedo (largest channel) at those views
  double albedo_max = 0;                                      // over all fitted views, largest channel
  double reciprocity = 0;                                     // of the model: fit/reciprocity.h
  std::optional<double> measured_reciprocity = std::nullopt;  // of the measurement, where it has pairs
  double tolerance = 0;
  double seconds = 0;  // wall clock of the fit
  uint64_t seed = 0;
  bool all_data = false;  // fitted without holding anything out
  OrderCurve order;
  std::vector<std::string> warnings;  // sentences
};

/// What the model was fitted from.
struct SourceRecord {
  std::string name, format, sha256;
};

/// Kinds of model; a new kind is appended.
using ModelBody = std::variant<ScatteredBrdf, ParametricBrdf, FactoredBtf, SrbfBtf, TensorBtf>;

/// Structure that lies over the surfaces of a material, and what is known of it.
struct ModelShell {
  std::shared_ptr<const OcclusionVolume> volume;
  std::string source;                                    // name of what was captured
  std::optional<OcclusionErrors> errors = std::nullopt;  // none: they were not looked for
};

struct Model {
  ModelBody body;
  FitRecord fit;
  SourceRecord source;
  /// Of a model that was reduced to what scenes need: its views are those of the body.
  std::optional<SceneRecord> scene = std::nullopt;
  /// Of a BTF, whose `fit` says nothing.
  std::optional<BtfRecord> btf = std::nullopt;
  std::optional<ModelShell> shell = std::nullopt;
};

uint64_t parameter_bytes(const ModelBody& body);

/// Whether the model holds for some scenes alone. One that was fitted for scenes which need all of the full model is
/// that full model, and holds for any.
bool is_reduced(const Model& model);

/// Whether it is of a BTF, with a BtfRecord, instead of a BRDF.
bool is_btf(const Model& model);

/// Whether a kind of body is of a BTF.
template <typename Body>
concept BtfBody = requires(const Body& body) {
  body.layout;
  body.grid;
  body.companding;
};

/// Calls `use` with the body of a BTF's model, whatever its kind. Throws std::bad_variant_access for a BRDF's.
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

/// The texels of a BTF's model; null of a BRDF's.
const TexelGrid* grid_of(const Model& model);

/// "scattered", "parametric", "factored-btf", "srbf-btf", "tensor-btf".
const char* model_kind(const Model& model);

}  // namespace velour
