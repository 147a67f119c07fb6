#include "capi/fit_reports.h"

#include "capi/json_text.h"
#include "capi/model_reports.h"
#include "capi/scene_reports.h"
#include "model/order_json.h"

namespace velour::capi {
namespace {

Json narrow_views(const Comparison& comparison) {
  Json json = Json::array();
  for (const auto& [degrees, share] : comparison.narrow_views) json.push_back(degrees);
  return json;
}

Json errors_of(const Comparison& comparison) {
  return {
      {"relative_l2", comparison.relative_l2}, {"by_view_angle", by_view_angle(comparison.by_view_angle)},
      {"log_rms", comparison.log_rms},         {"noise_by_view_angle", by_view_angle(comparison.noise_by_view_angle)},
      {"samples", comparison.samples},         {"narrow_views", narrow_views(comparison)}};
}

Json peer_of(const GgxParameters& p) {
  return {{"ggx",
           {{"alpha", {p.alpha.x, p.alpha.y}},
            {"f0", colour(p.f0)},
            {"f90", colour(p.f90)},
            {"diffuse", colour(p.diffuse)}}}};
}

Json peer_of(const PrincipledParameters& p) {
  return {{"principled",
           {{"base_color", colour(p.base_color)},
            {"metallic", p.metallic},
            {"roughness", p.roughness},
            {"specular", p.specular},
            {"specular_tint", colour(p.specular_tint)},
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
                   {"warnings", model.fit.warnings},
                   {"order", order_json(model.fit.order)}});
  if (const auto* brdf = std::get_if<ParametricBrdf>(&model.body)) json["view_range"] = views_json(brdf->views);
  if (model.scene) json["scene"] = reduced_json(*model.scene);
  return text(json);
}

std::string comparison_json(const Comparison& comparison) { return text(errors_of(comparison)); }

std::string peer_json(const PeerFit& fit) {
  Json json = errors_of(fit.error);
  json.update(Json{{"seconds", fit.seconds}, {"parameter_bytes", fit.parameter_bytes()}});
  json.update(std::visit([](const auto& p) { return peer_of(p); }, fit.parameters));
  return text(json);
}

}  // namespace velour::capi
