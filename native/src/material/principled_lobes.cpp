#include "material/principled_lobes.h"

#include <algorithm>

#include "material/ggx.h"

namespace velour {

#include "material/principled_formulas-inl.h"

namespace {

/// Blender's scale: specular 0.5 is 4 % at normal incidence, an index of 1.5.
float index_of(float specular) {
  const float root = std::sqrt(std::clamp(0.08f * specular, 0.0f, 0.9f));
  return (1 + root) / (1 - root);
}

float rough_enough(float roughness) { return std::clamp(roughness, kMinRoughness, 1.0f); }

PrincipledParameters within_ranges(PrincipledParameters p) {
  p.base_color = glm::clamp(p.base_color, Rgb(0), Rgb(1));
  p.specular_tint = glm::clamp(p.specular_tint, Rgb(0), Rgb(1));
  p.metallic = std::clamp(p.metallic, 0.0f, 1.0f);
  p.roughness = rough_enough(p.roughness);
  p.coat = std::clamp(p.coat, 0.0f, 1.0f);
  p.coat_roughness = rough_enough(p.coat_roughness);
  return p;
}

}  // namespace

PrincipledLobes::PrincipledLobes(const PrincipledParameters& p)
    : parameters_(within_ranges(p)), eta_(index_of(p.specular)), f0_(dielectric_fresnel(1.0f, eta_)) {
  make_tables(true, true);
}

PrincipledLobes PrincipledLobes::with(const PrincipledParameters& p) const {
  PrincipledLobes other = *this;
  other.parameters_ = within_ranges(p);
  other.eta_ = index_of(p.specular);
  other.f0_ = dielectric_fresnel(1.0f, other.eta_);
  const bool coated = parameters_.coat > 0, will_be = other.parameters_.coat > 0;
  other.make_tables(other.alpha() != alpha() || other.eta_ != eta_,
                    coated != will_be || (coated && other.coat_alpha() != coat_alpha()));
  return other;
}

void PrincipledLobes::blend(const PrincipledParameters& parameters, const PrincipledLobes& a, const PrincipledLobes& b,
                            float share) {
  parameters_ = within_ranges(parameters);
  eta_ = a.eta_;
  f0_ = a.f0_;
  dielectric_ = SpecularAlbedo::between(a.dielectric_, b.dielectric_, share);
  coat_ = a.coat_;
  top_ = SpecularAlbedo::between(a.top_, b.top_, share);
}

void PrincipledLobes::make_tables(bool dielectric, bool coat) {
  if (dielectric) {
    dielectric_ = f0_ > 0 ? SpecularAlbedo(alpha(), [this](float cosine) { return dielectric_fresnel(cosine, eta_); })
                          : SpecularAlbedo();
  }
  if (coat) {
    coat_ = parameters_.coat > 0
                ? SpecularAlbedo(coat_alpha(), [](float cosine) { return dielectric_fresnel(cosine, kCoatIndex); })
                : SpecularAlbedo();
  }
  top_ = SpecularAlbedo::layered(coat_, parameters_.coat, dielectric_);
}

PrincipledLobes::View PrincipledLobes::view(const Vec3& wv) const {
  const float base = (1 - parameters_.metallic) * (1 - top_.at(wv.z));
  return {wv, base / (kPi * (1 - top_.mean())), 1 - coat_albedo(wv.z)};
}

PrincipledLobes::Layers PrincipledLobes::layers() const {
  return {alpha(), coat_alpha(), eta_, f0_, parameters_.metallic, parameters_.coat, &coat_.table(), &top_.table()};
}

float PrincipledLobes::value(const Parts& parts, float base_color, float specular_tint) {
  return principled_value(parts, base_color, specular_tint);
}

Rgb PrincipledLobes::value(const Parts& p) const {
  Rgb f;
  for (int c = 0; c < 3; ++c) f[c] = value(p, parameters_.base_color[c], parameters_.specular_tint[c]);
  return f;
}

float PrincipledLobes::fresnel_luminance(float cosine) const {
  return luminance(value(principled_reflected(layers(), 1.0f, cosine)));
}

PrincipledLobes::Parts PrincipledLobes::parts(const View& view, const Vec3& wl, const Vec3& h) const {
  return principled_parts(layers(), view, wl, h);
}

}  // namespace velour
