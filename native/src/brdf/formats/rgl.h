// The adaptive parameterization of the RGL material database [RGL].
#pragma once

#include <memory>
#include <span>
#include "brdf/formats/bilinear_warp.h"
#include "brdf/formats/rgl_positions.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/measurement.h"
#include "brdf/measure/table_measurement.h"

namespace velour {

/// True for bytes that begin like the tensor container of .bsdf files.
bool looks_like_rgl(std::span<const uint8_t> head);

/// `provenance` has path, name, sha256 and size already. Colors come from "rgb", else from "spectra" and "wavelengths".
std::shared_ptr<const Measurement> read_rgl(std::span<const uint8_t> bytes, Provenance provenance);

// The run-time look-up of an RGL measurement.

/// Node values over (theta, phi) in the paper's units; width is the axis of theta.
struct AngleGrid {
  uint32_t width = 0, height = 0;
  std::vector<float> values;

  /// Bilinear at `u` in the unit square.
  float at(const Vec2& u) const;
};

/// Contents of the file, checked.
struct RglTables {
  std::vector<float> phi_v, theta_v;  // radians, increasing: the views; one phi (or two): isotropic
  AngleGrid normals, projected_area;  // D(theta_m, phi_m) and sigma(theta_v, phi_v)
  uint32_t warp_width = 0, warp_height = 0;
  std::vector<float> visible_normals;  // views x height x width
  uint32_t width = 0, height = 0;      // of the color slices
  std::vector<Rgb> color;              // views x height x width
  bool microfacet_scale = true;        // the file's "jacobian": multiply colors by D / (4 sigma)
};

class RglMeasurement : public Measurement {
 public:
  RglMeasurement(RglTables tables, Provenance provenance);

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override;
  bool isotropic() const override { return tables_.phi_v.size() <= 2; }
  bool covers_view(float theta_v) const override { return coverage_.covers(theta_v); }
  std::vector<std::pair<std::string, std::string>> details() const override;

 private:
  /// View-dependent state.
  struct View {
    RglView frame;
    SliceMix mix;
    float scale = 1;  // 1 / (4 sigma)
    bool covered = false;
  };
  View prepare(const Vec3& wv) const;
  SliceMix mix_of(float phi, float theta) const;
  bool lookup(const View& view, const Vec2& position, const Vec2& u, float cosine, Rgb& f) const;
  void build_nodes();
  bool texel_above_horizon(uint32_t slice, uint32_t y, uint32_t x) const;

  RglTables tables_;
  BilinearWarp warp_;
  std::vector<TableNode> nodes_;
  int sectors_ = 1;  // the views span 2 pi / sectors; the rest follows by symmetry
  ViewCoverage coverage_;
};

}  // namespace velour
