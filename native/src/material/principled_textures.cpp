#include "material/principled_textures.h"

#include <algorithm>

#include "material/ggx.h"
#include "material/principled_sampling.h"
#include "material/principled_table.h"

namespace velour {
namespace {

class TexturedMaterial final : public PrincipledSampling {
 public:
  TexturedMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures, float alpha)
      : parameters_(parameters), textures_(textures), alpha_(alpha), table_(PrincipledTable::shared(parameters)) {}

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    PrincipledParameters p = parameters_;
    p.base_color = textures_.base_color.at(site, p.base_color);
    p.metallic = textures_.metallic.at(site, p.metallic);
    p.roughness = textures_.roughness.at(site, p.roughness);
    table_->look_up(p, point.principled);
    const PrincipledLobes::View view = point.principled.view(wv);
    set_up(point.principled, view, specular_albedo(point.principled, view), point);
  }

  bool varies() const override { return textures_.any(); }

  bool opaque() const override { return !textures_.alpha.given() && alpha_ >= 1.0f; }

  float alpha(const SurfaceSite& site) const override {
    return std::clamp(textures_.alpha.at(site, alpha_), 0.0f, 1.0f);
  }

 private:
  /// A metal's as if it were smooth: too much where it is rough and seen at a grazing angle.
  static float specular_albedo(const PrincipledLobes& lobes, const PrincipledLobes::View& view) {
    const PrincipledParameters& p = lobes.parameters();
    const float metal = luminance(schlick_fresnel(p.base_color, view.wv.z));
    return (1 - p.metallic) * lobes.dielectric_albedo(view) + p.metallic * view.through * metal;
  }

  const PrincipledLobes& lobes(const PreparedBrdf& point) const override { return point.principled; }

  const PrincipledParameters parameters_;
  const PrincipledTextures textures_;
  const float alpha_;
  const std::shared_ptr<const PrincipledTable> table_;
};

}  // namespace

std::shared_ptr<const Material> make_textured_material(const PrincipledParameters& parameters,
                                                       const PrincipledTextures& textures, float alpha) {
  return std::make_shared<TexturedMaterial>(parameters, textures, alpha);
}

}  // namespace velour
