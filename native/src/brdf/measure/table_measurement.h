// A measurement that is a table over half and difference angles.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"

namespace velour {

// View angles that a measurement covers.

class ViewCoverage {
 public:
  ViewCoverage() = default;
  /// Evaluates `measurement` at every integer degree (0..89, azimuth 0) for a few hundred equal-area light directions;
  /// a view is covered if at least half of them are.
  explicit ViewCoverage(const Measurement& measurement);

  /// `theta_v` in radians; the nearest whole degree decides. False at and below the horizon.
  bool covers(float theta_v) const;

 private:
  std::array<bool, 90> covered_{};
};

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
