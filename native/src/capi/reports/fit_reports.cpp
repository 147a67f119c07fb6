#include "capi/reports/reports.h"

#include <algorithm>
#include "btf/model/tensor_btf.h"
#include "btf/model/tensor_evaluator.h"
#include "model/file/record_json.h"
#include "model/roughened_model.h"

namespace velour::capi {

namespace {

Json verdict_or_null(const std::optional<Verdict>& verdict) { return verdict ? verdict_json(*verdict) : Json(nullptr); }

Json errors_of(const Comparison& comparison) {
  return {{"relative_l2", comparison.relative_l2},
          {"by_view_angle", by_view_angle(comparison.by_view_angle)},
          {"standard_error", comparison.standard_error},
          {"standard_error_by_view_angle", by_view_angle(comparison.standard_error_by_view_angle)},
          {"log_rms", comparison.log_rms},
          {"noise_by_view_angle", by_view_angle(comparison.noise_by_view_angle)},
          {"samples", comparison.samples}};
}

Json peer_of(const GgxParameters& p) {
  return {
      {"ggx",
       {{"alpha", {p.alpha.x, p.alpha.y}}, {"f0", color(p.f0)}, {"f90", color(p.f90)}, {"diffuse", color(p.diffuse)}}}};
}

Json peer_of(const PrincipledParameters& p) {
  return {{"principled",
           {{"base_color", color(p.base_color)},
            {"metallic", p.metallic},
            {"roughness", p.roughness},
            {"specular", p.specular},
            {"specular_tint", color(p.specular_tint)},
            {"coat", p.coat},
            {"coat_roughness", p.coat_roughness}}}};
}

}  // namespace

std::string fit_json(const Model& model, uint64_t file_bytes) {
  Json json = size_json(model, file_bytes);
  json.update(Json{{"seconds", model.fit.seconds},
                   {"relative_l2", model.fit.relative_l2},
                   {"by_view_angle", by_view_angle(model.fit.by_view_angle)},
                   {"albedo_max", model.fit.albedo_max},
                   {"reciprocity", model.fit.reciprocity},
                   {"measured_reciprocity", or_null(model.fit.measured_reciprocity)},
                   {"verdict", verdict_or_null(model.fit.verdict)},
                   {"warning_codes", warnings_json(model.fit.warnings)},
                   {"order", order_json(model.fit.order)}});
  if (const auto* brdf = std::get_if<ParametricBrdf>(&model.body)) json["view_range"] = views_json(brdf->views);
  if (model.scene) json["scene"] = reduced_json(*model.scene);
  return text(json);
}

std::string comparison_json(const Comparison& comparison, const std::optional<Verdict>& verdict) {
  Json json = errors_of(comparison);
  json["verdict"] = verdict_or_null(verdict);
  return text(json);
}

std::string peer_json(const PeerFit& fit) {
  Json json = errors_of(fit.error);
  json.update(Json{{"seconds", fit.seconds}, {"parameter_bytes", fit.parameter_bytes()}});
  json.update(std::visit([](const auto& p) { return peer_of(p); }, fit.parameters));
  return text(json);
}

namespace {

Json curve_json(const ClosureCurve<Rgb>& curve) {
  Json json = Json::array();
  for (const Rgb& c : curve) json.push_back(color(c));
  return json;
}

/// `input` gives the value at a sample and its theta_v.
template <class Input>
Json input_json(const ClosureCurve<float>& curve, const Input& input) {
  Json json = Json::array();
  for (size_t i = 0; i < curve.size(); ++i) {
    json.push_back(input(curve[i], 0.5f * kPi * static_cast<float>(i) / (kClosureSamples - 1)));
  }
  return json;
}

Json lobe_json(const ClosureLobe& lobe) {
  constexpr const char* kNames[] = {"GGX", "BECKMANN", "ASHIKHMIN_SHIRLEY"};
  return {{"distribution", kNames[static_cast<size_t>(lobe.distribution)]},
          {"color", curve_json(lobe.weight)},
          {"roughness", lobe.roughness},
          {"tilt", input_json(lobe.tilt, incoming_factor)},
          {"anisotropy", input_json(lobe.anisotropy, [](float value, float) { return anisotropy_input(value); })}};
}

}  // namespace

std::string closures_json(const ModelClosures& closures) {
  const ClosureFit& fit = closures.fit;
  Json lobes = Json::array(), views = Json::array(), errors = Json::array();
  for (const ClosureLobe& lobe : fit.network.lobes) lobes.push_back(lobe_json(lobe));
  for (const ClosureViewError& e : fit.errors) {
    views.push_back(e.degrees);
    errors.push_back(e.luminance);
  }
  return text(Json{{"frame", fit.network.frame == ClosureFrame::surface ? "surface" : "incidence"},
                   {"lobes", lobes},
                   {"diffuse", curve_json(fit.network.diffuse)},
                   {"views", views},
                   {"relative_l2", errors},
                   {"relative_l2_mean", fit.mean_error},
                   {"albedo_excess", fit.albedo_excess},
                   {"seconds", closures.seconds},
                   {"reason", closures.reason}});
}

namespace {

Json count_json(const PerViewBrdf& brdf) { return {{"lobes", brdf.lobe_count()}}; }
Json count_json(const ParametricBrdf& brdf) { return {{"lobes", brdf.lobe_count()}}; }
Json count_json(const FactoredBtf& btf) { return {{"components", btf.components()}}; }

/// Largest counts of any side.
Json count_json(const SrbfBtf& btf) {
  size_t lobes = 0, coefficients = 0;
  for (const SrbfSide& side : btf.sides) {
    lobes = std::max(lobes, side.lobes.size());
    coefficients = std::max(coefficients, side.coefficients());
  }
  return {{"lobes", lobes}, {"coefficients", coefficients}};
}

/// Largest number of coefficients per texel of any side.
Json count_json(const TensorBtf& btf) {
  size_t coefficients = 0;
  for (const TensorSide& side : btf.sides) {
    coefficients = std::max(coefficients, size_t{side.members} * side.rank.texel);
  }
  return {{"coefficients", coefficients}};
}

/// Keys of one kind of model only.
Json own_json(const PerViewBrdf& brdf) {
  return {{"kernel", kernel_name(brdf.kernel)},
          {"isotropic", brdf.isotropic},
          {"views", brdf.views.size()},
          {"narrowest_roughness", narrowest_roughness(brdf)},
          {"max_lobes_per_view", brdf.max_lobes_per_view()}};
}

Json own_json(const ParametricBrdf& brdf) {
  const auto half = std::count(brdf.space.begin(), brdf.space.end(), LobeSpace::half);
  return {{"kernel", kernel_name(Kernel::gaussian)},
          {"isotropic", brdf.isotropic},
          {"cells", brdf.cells},
          {"narrowest_roughness", narrowest_roughness(brdf)},
          {"symmetric", brdf.symmetric},
          {"view_range", views_json(brdf.views)},
          {"spaces", {{"light", brdf.lobe_count() - half}, {"half", half}}}};
}

template <class Btf>
Json btf_own_json(const Btf& btf) {
  return {{"texels", {btf.grid.width, btf.grid.height}},
          {"tile_metres", tile_json(btf.grid)},
          {"views", btf.layout.views().size()},
          {"lights", btf.layout.lights().size()},
          {"companding", btf.companding == Companding::root ? "root" : "none"}};
}

Json own_json(const FactoredBtf& btf) { return btf_own_json(btf); }

const char* where(bool below) { return below ? "below" : "above"; }

/// Keys of one kind of side only.
Json own_side_json(const SrbfBtf&, const SrbfSide& side) {
  return {{"lobes", {{"tile", side.tile_lobes}, {"texel", side.lobes.size() - side.tile_lobes}}}};
}
Json own_side_json(const TensorBtf& btf, const TensorSide& side) {
  const TensorSide::Ranks& rank = side.rank;
  const TensorBytes bytes = bytes_of(side);
  return {{"clusters", side.clusters.size()},
          {"members", side.members},
          {"ranks", {{"texel", rank.texel}, {"view", rank.view}, {"light", rank.light}, {"color", rank.color}}},
          {"relief", !side.levels.at(0).relief.empty()},
          {"table_bytes", TensorContraction::bytes(btf, side, TensorEvaluator::kMaxTableBytes)},
          {"bytes",
           {{"coefficients", bytes.coefficients},
            {"members", bytes.members},
            {"relief", bytes.relief},
            {"factors", bytes.factors},
            {"cores", bytes.cores},
            {"scales", bytes.scales}}}};
}

/// The sides of a BTF, then those served by another side, with the same fields.
template <class Btf>
Json sided_json(const Btf& btf) {
  Json json = btf_own_json(btf), sides = Json::array();
  for (const auto& side : btf.sides) {
    Json& row = sides.emplace_back(Json{{"view", where(side.view_below)}, {"light", where(side.light_below)}});
    row.update(own_side_json(btf, side));
    row.update(Json{{"parameter_bytes", side.parameter_bytes()}, {"as", nullptr}});
  }
  for (const SharedSide& shared : btf.shared) {
    Json row = sides.at(shared.side);
    for (auto& [key, value] : row.items()) value = nullptr;
    row.update(Json{{"view", where(shared.view_below)},
                    {"light", where(shared.light_below)},
                    {"parameter_bytes", 0},
                    {"as", shared.side}});
    sides.push_back(row);
  }
  json["sides"] = std::move(sides);
  return json;
}

Json own_json(const SrbfBtf& btf) { return sided_json(btf); }
Json own_json(const TensorBtf& btf) { return sided_json(btf); }

/// Results of the fit of a BRDF.
Json record_json(const FitRecord& fit) {
  return {{"relative_l2", fit.relative_l2},
          {"by_view_angle", by_view_angle(fit.by_view_angle)},
          {"albedo_by_view_angle", by_view_angle(fit.albedo_by_view_angle)},
          {"albedo_max", fit.albedo_max},
          {"reciprocity", fit.reciprocity},
          {"measured_reciprocity", or_null(fit.measured_reciprocity)},
          {"tolerance", fit.tolerance},
          {"seed", fit.seed},
          {"all_data", fit.all_data},
          {"verdict", verdict_or_null(fit.verdict)},
          {"warning_codes", warnings_json(fit.warnings)},
          {"order", order_json(fit.order)}};
}

/// Results of the fit of a BTF.
Json record_json(const BtfRecord& btf) {
  const bool measured = btf.relative_l2 > 0;
  return {{"method", btf.method},
          {"psnr", btf.psnr},
          {"psnr_held_out", or_null(btf.psnr_held_out)},
          {"ser", btf.ser},
          {"p99", btf.p99},
          {"raw_bytes", btf.raw_bytes},
          {"seed", btf.seed},
          {"verdict", verdict_or_null(btf.verdict)},
          {"warning_codes", warnings_json(btf.warnings)},
          {"relative_l2", measured ? Json(btf.relative_l2) : Json()},
          {"tolerance", btf.tolerance},
          {"order", order_json(btf.order)},
          {"search", trials_json(btf.search)},
          {"shapes", shapes_json(btf.shapes)}};
}

Json shell_json(const ModelShell& shell) {
  const VotfVolume& v = *shell.volume;
  const auto of_errors = [&](double VotfErrors::*value) {
    return shell.errors ? Json((*shell.errors).*value) : Json();
  };
  return {{"source", shell.source},
          {"bytes", v.parameter_bytes()},
          {"points", {v.width, v.height, v.depth}},
          {"heights", {v.bottom, v.top}},
          {"tile_width", v.tile_width > 0 ? Json(v.tile_width) : Json()},
          {"closed", v.closed},
          {"coverage", of_errors(&VotfErrors::coverage)},
          {"wrong", of_errors(&VotfErrors::wrong)}};
}

}  // namespace

Json size_json(const Model& model, uint64_t file_bytes) {
  return std::visit(
      [&](const auto& body) {
        Json json = count_json(body);
        json.update(Json{{"bytes", file_bytes}, {"parameter_bytes", body.parameter_bytes()}});
        return json;
      },
      model.body);
}

std::string votf_json(const ModelShell& shell, double seconds, const std::vector<Warning>& warnings) {
  Json json = shell_json(shell);
  json.update(Json{{"seconds", seconds}, {"warning_codes", warnings_json(warnings)}});
  return text(json);
}

std::string model_json(const Model& model, uint64_t file_bytes) {
  Json json = {{"kind", "model"}, {"model", model_kind(model)}};
  json.update(std::visit([](const auto& brdf) { return own_json(brdf); }, model.body));
  json.update(size_json(model, file_bytes));
  json.update(model.btf ? record_json(*model.btf) : record_json(model.fit));
  json["source"] = {{"name", model.source.name}, {"format", model.source.format}, {"sha256", model.source.sha256}};
  if (model.scene) json["scene"] = reduced_json(*model.scene);
  if (model.shell) json["shell"] = shell_json(*model.shell);
  return text(json);
}

}  // namespace velour::capi
