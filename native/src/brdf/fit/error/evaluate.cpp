#include "brdf/fit/error/evaluate.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include "brdf/measure/held_out.h"

namespace velour {

void evaluate(const Material& material, const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
              std::span<float> density) {
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  DirectionBatch batch;
  RgbBatch values;
  ScalarBatch pdf;
  for (size_t begin = 0; begin < wl.size(); begin += DirectionBatch::kCapacity) {
    const size_t end = std::min(begin + DirectionBatch::kCapacity, wl.size());
    batch.count = 0;
    for (size_t i = begin; i < end; ++i) batch.push(wl[i]);
    batch.pad();
    point->eval(batch, values, pdf);
    for (size_t i = begin; i < end && !f.empty(); ++i) f[i] = values.get(static_cast<int>(i - begin));
    if (!density.empty()) std::copy_n(pdf.v, end - begin, density.data() + begin);
  }
}

std::vector<Vec3> reported_views(int degrees, bool isotropic) {
  std::vector<Vec3> views;
  for (int azimuth = 0; azimuth < (isotropic ? 1 : 8); ++azimuth) {
    views.push_back(direction(radians_from(static_cast<float>(degrees)), kPi / 4 * static_cast<float>(azimuth)));
  }
  return views;
}

int reported_view_of(const Vec3& wv) {
  const double theta = std::acos(std::clamp(static_cast<double>(wv.z), -1.0, 1.0)) * 180 / kPiD;
  const auto nearest = std::min_element(kHeldOutViews.begin(), kHeldOutViews.end(),
                                        [theta](int a, int b) { return std::abs(theta - a) < std::abs(theta - b); });
  return std::abs(theta - *nearest) <= kHeldOutGroup ? *nearest : -1;
}

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
