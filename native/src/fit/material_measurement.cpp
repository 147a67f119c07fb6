#include "fit/material_measurement.h"

#include <algorithm>

#include "fit/evaluate.h"

namespace velour {

MaterialMeasurement::MaterialMeasurement(std::shared_ptr<const Material> material, const ViewRange& views)
    : material_(std::move(material)), views_(views) {}

void MaterialMeasurement::eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
                               std::span<uint8_t> valid) const {
  if (!(wv.z > 0)) {
    std::fill(f.begin(), f.end(), Rgb(0));
    std::fill(valid.begin(), valid.end(), uint8_t{0});
    return;
  }
  evaluate(*material_, wv, wl, f);
  for (size_t i = 0; i < wl.size(); ++i) {
    valid[i] = wl[i].z > 0;
    if (!valid[i]) f[i] = Rgb(0);
  }
}

bool MaterialMeasurement::covers_view(float theta_v) const { return views_.holds(theta_v); }

}  // namespace velour
