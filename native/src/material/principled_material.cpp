#include "material/principled_material.h"

#include "material/principled_sampling.h"

namespace velour {

namespace {

class PrincipledMaterial final : public PrincipledSampling {
 public:
  explicit PrincipledMaterial(const PrincipledParameters& p)
      : lobes_(p), specular_(lobes_.alpha(), [this](float cosine) { return lobes_.fresnel_luminance(cosine); }) {}

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    const PrincipledLobes::View view = lobes_.view(wv);
    set_up(lobes_, view, view.through * specular_.at(wv.z), point);
  }

 private:
  const PrincipledLobes& lobes(const PreparedBrdf& /*point*/) const override { return lobes_; }

  PrincipledLobes lobes_;
  SpecularAlbedo specular_;  // of metal and dielectric, in luminance
};

}  // namespace

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters) {
  return std::make_shared<PrincipledMaterial>(parameters);
}

}  // namespace velour
