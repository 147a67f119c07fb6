#include "brdf/measure/table_measurement.h"

#include <algorithm>
#include <cmath>
#include "math/sphere/directions.h"

namespace velour {

TableMeasurement::TableMeasurement(HalfDiffTable table, Provenance provenance, const EntryCounts& counts,
                                   Details details)
    : table_(std::move(table)), details_(std::move(details)) {
  provenance_ = std::move(provenance);
  counts_ = counts;
  coverage_ = ViewCoverage(*this);
}

void TableMeasurement::eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
                            std::span<uint8_t> valid) const {
  for (size_t i = 0; i < wl.size(); ++i) {
    const bool above = wv.z > 0.0f && wl[i].z > 0.0f;
    if (!above) f[i] = Rgb(0.0f);
    valid[i] = above && table_.lookup(wl[i], wv, f[i]);
  }
}

ViewCoverage::ViewCoverage(const Measurement& measurement) {
  const auto lights = hemisphere_fibonacci(256);
  std::vector<Rgb> f(lights.size());
  std::vector<uint8_t> valid(lights.size());
  for (size_t degree = 0; degree < covered_.size(); ++degree) {
    measurement.eval(direction(radians_from(static_cast<float>(degree)), 0.0f), lights, f, valid);
    const auto hits = std::count(valid.begin(), valid.end(), uint8_t{1});
    covered_[degree] = static_cast<size_t>(hits) * 2 >= lights.size();
  }
}

bool ViewCoverage::covers(float theta_v) const {
  if (!(theta_v >= 0.0f && theta_v < kPi / 2)) return false;
  const auto degree = static_cast<size_t>(std::lround(theta_v * (180.0f / kPi)));
  return covered_[std::min(degree, covered_.size() - 1)];
}

}  // namespace velour
