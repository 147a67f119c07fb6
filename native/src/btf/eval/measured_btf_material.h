// Material of an uncompressed BTF: reference mode.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>
#include "btf/measure/btf_measurement.h"
#include "btf/measure/half_floats.h"
#include "btf/measure/pair_layout.h"
#include "material/material.h"
#include "math/sphere/warp.h"

namespace velour {

// Which side of the surface a BTF material is lit from.

/// f is given for light from one side of the surface. For other_side, light directions are mirrored (z > 0).
enum class BtfLight { viewers_side, other_side };

// A whole BTF in memory, for random access.

/// f in 1/sr as in BtfMeasurement, with mip levels that hold means of f over areas. Texels come before lights because
/// shading looks up many lights at one place. All values are finite. Immutable.
struct BtfTable {
  struct Level {
    uint32_t width = 0, height = 0;
    std::vector<HalfBits> value;  // [view][row][column][light][channel], row 0 at the bottom
  };
  PairInterpolation between;
  size_t lights = 0;
  std::vector<Level> levels;  // finest first; each half the size of the previous one, down to one texel

  /// Values of all lights, 3 each.
  const HalfBits* row(size_t level, uint32_t view, uint64_t texel) const {
    const Level& of = levels[level];
    return of.value.data() + (view * (uint64_t{of.width} * of.height) + texel) * lights * 3;
  }
};

/// Default memory limit, enough for 256 x 256 texels and 81 x 81 directions.
inline constexpr uint64_t kUsualTableBytes = uint64_t{4} << 30;

/// Reads the BTF view by view, buffering one view's images. Entries that are not finite become the mean of their image.
/// Throws Error(unsupported) if pairs are missing or the table would exceed `most_bytes`, and what read_pairs() throws.
std::shared_ptr<const BtfTable> read_btf_table(const BtfMeasurement& btf, uint64_t most_bytes = kUsualTableBytes);

/// f interpolated from the table: barycentric between views and between lights, bilinear between texels, trilinear
/// between levels along the footprint [Wil83, MPFJ99], all linear in f; negative sums become 0. Texture coordinates are
/// in tiles. Sampling is cosine-weighted.
std::shared_ptr<const Material> make_measured_btf_material(std::shared_ptr<const BtfTable> table,
                                                           BtfLight light = BtfLight::viewers_side);

// Base classes of BTF materials without lobes: cosine-weighted sampling.

/// A BTF at a point, evaluated one direction at a time.
class PreparedCosineBtf : public PreparedBrdf {
 public:
  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const final {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, value(wl.get(i)));
      pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const final {
    wl.fill(u, [](const Vec2& v) { return sample_cosine_hemisphere(v); });
  }

 protected:
  ~PreparedCosineBtf() = default;
  /// f, 0 where wl.z <= 0.
  virtual Rgb value(const Vec3& wl) const = 0;
};

class CosineBtfMaterial : public Material {
 public:
  explicit CosineBtfMaterial(BtfLight light) : beyond_(light == BtfLight::other_side) {}

  bool varies() const final { return true; }
  bool isotropic() const final { return false; }

  /// `w` in the frame of a two-sided BTF; `back`: seen from below.
  static Vec3 turned(const Vec3& w, bool back) { return {w.x, w.y, back ? -w.z : w.z}; }
  /// turned() of a light direction, which BtfLight::other_side mirrors once more.
  Vec3 turned_light(const Vec3& wl, bool back) const { return turned(wl, back != beyond_); }

 private:
  bool beyond_;
};

}  // namespace velour
