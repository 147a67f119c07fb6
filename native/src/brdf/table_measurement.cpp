#include "brdf/table_measurement.h"

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

}  // namespace velour
