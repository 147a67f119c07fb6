// Base class of BTF materials without lobes: cosine-weighted sampling.
#pragma once

#include "material/btf_light.h"
#include "material/material.h"
#include "sphere/warp.h"

namespace velour {

/// A spatially varying material that evaluates one direction at a time.
class CosineBtfMaterial : public Material {
 public:
  explicit CosineBtfMaterial(BtfLight light) : beyond_(light == BtfLight::other_side) {}

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const final {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, value(point, wl.get(i)));
      pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
    }
  }

  void sample(const PreparedBrdf& /*point*/, std::span<const Vec2> u, DirectionBatch& wl) const final {
    wl.fill(u, [](const Vec2& v) { return sample_cosine_hemisphere(v); });
  }

  bool varies() const final { return true; }
  bool isotropic() const final { return false; }

 protected:
  /// f, 0 where wl.z <= 0.
  virtual Rgb value(const PreparedBrdf& point, const Vec3& wl) const = 0;

  /// `w` in the frame of a two-sided BTF; `back`: seen from below.
  static Vec3 turned(const Vec3& w, bool back) { return {w.x, w.y, back ? -w.z : w.z}; }
  /// turned() of a light direction, which BtfLight::other_side mirrors once more.
  Vec3 turned_light(const Vec3& wl, bool back) const { return turned(wl, back != beyond_); }

 private:
  bool beyond_;
};

}  // namespace velour
