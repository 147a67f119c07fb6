// Measurements with a formula behind them: what a fit should find is known.
#pragma once

#include <functional>
#include <memory>

#include "brdf/measure/measurement.h"

namespace velour::test {

/// f of a pair; covered where `covers` says so.
class AnalyticMeasurement : public Measurement {
 public:
  using Formula = std::function<Rgb(const DirectionPair&)>;
  using Coverage = std::function<bool(const DirectionPair&)>;

  explicit AnalyticMeasurement(Formula f, bool isotropic = true) : f_(std::move(f)), isotropic_(isotropic) {
    provenance_.name = "analytic";
    provenance_.format = "test";
    provenance_.path = "analytic.test";
  }
  void set_coverage(Coverage covers) { covers_ = std::move(covers); }
  void set_counts(const EntryCounts& counts) { counts_ = counts; }

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    for (size_t i = 0; i < wl.size(); ++i) {
      const DirectionPair pair{wl[i], wv};
      valid[i] = wl[i].z > 0 && wv.z > 0 && (!covers_ || covers_(pair));
      f[i] = valid[i] ? f_(pair) : Rgb(0);
    }
  }
  bool isotropic() const override { return isotropic_; }
  bool covers_view(float theta_v) const override { return theta_v < radians_from(89.5f); }

 private:
  Formula f_;
  Coverage covers_;
  bool isotropic_;
};

inline Rgb lambert(const DirectionPair&) { return Rgb(0.5f, 0.4f, 0.3f) / kPi; }

/// GGX without Fresnel: D G2 / (4 cos cos), Smith's height-correlated masking.
inline AnalyticMeasurement::Formula ggx(float alpha_x, float alpha_y) {
  return [alpha_x, alpha_y](const DirectionPair& p) {
    const Vec3 h = glm::normalize(p.wl + p.wv);
    const float e = h.x * h.x / (alpha_x * alpha_x) + h.y * h.y / (alpha_y * alpha_y) + h.z * h.z;
    const float d = 1 / (kPi * alpha_x * alpha_y * e * e);
    const auto lambda = [&](const Vec3& w) {
      const float t = (alpha_x * alpha_x * w.x * w.x + alpha_y * alpha_y * w.y * w.y) / (w.z * w.z);
      return 0.5f * (std::sqrt(1 + t) - 1);
    };
    return Rgb(0.9f, 0.7f, 0.5f) * (d / (1 + lambda(p.wl) + lambda(p.wv)) / (4 * p.wl.z * p.wv.z));
  };
}

}  // namespace velour::test
