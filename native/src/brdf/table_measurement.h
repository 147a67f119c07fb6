// A measurement that is a table over half and difference angles.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "brdf/half_diff_table.h"
#include "brdf/view_coverage.h"

namespace velour {

class TableMeasurement : public Measurement {
 public:
  using Details = std::vector<std::pair<std::string, std::string>>;

  TableMeasurement(HalfDiffTable table, Provenance provenance, const EntryCounts& counts, Details details);

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override;
  bool isotropic() const override { return table_.layout().phi_h == 1; }
  bool covers_view(float theta_v) const override { return coverage_.covers(theta_v); }
  Details details() const override { return details_; }

 private:
  HalfDiffTable table_;
  Details details_;
  ViewCoverage coverage_;
};

}  // namespace velour
