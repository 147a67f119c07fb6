#include "fit/directional_albedo.h"

#include <vector>

#include "fit/evaluate.h"
#include "fit/view_grid.h"

namespace velour {

Vec3d directional_albedo(const Material& material, const Vec3& wv) {
  const LightGrid grid = light_grid(wv);
  std::vector<Rgb> f(grid.wl.size());
  evaluate(material, wv, grid.wl, f);
  Vec3d albedo(0);
  for (size_t i = 0; i < f.size(); ++i) albedo += Vec3d(f[i]) * static_cast<double>(grid.weight[i] * grid.wl[i].z);
  return albedo;
}

MeasuredAlbedo directional_albedo(const Measurement& measurement, const Vec3& wv) {
  const LightGrid grid = light_grid(wv);
  std::vector<Rgb> f(grid.wl.size());
  std::vector<uint8_t> valid(grid.wl.size());
  measurement.eval(wv, grid.wl, f, valid);
  MeasuredAlbedo out;
  double all = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    const double weight = static_cast<double>(grid.weight[i] * grid.wl[i].z);
    all += weight;
    if (!valid[i]) continue;
    out.albedo += Vec3d(f[i]) * weight;
    out.covered += weight;
  }
  if (all > 0) out.covered /= all;
  return out;
}

}  // namespace velour
