// The views of a BTF as matrices, one per color axis, and those of one side of the plane.
#pragma once

#include <array>
#include <vector>
#include "base/progress.h"
#include "btf/model/factored_btf.h"
#include "math/tensor/tensor_view.h"

namespace velour {

/// Reads views one by one. Entries that are not finite are counted and replaced by the mean of their image, so that
/// they do not bias the fit. Companding by roots treats negative f as 0.
class CompandedViews {
 public:
  CompandedViews(const BtfMeasurement& btf, Companding companding, int threads, const Progress& progress);

  /// Reads linear f, [light][texel x 3].
  void read(uint32_t view, std::vector<float>& f);
  /// Companded f along the three axes, a matrix light x texel each.
  using Planes = std::array<RowMatrix, 3>;
  void planes(const std::vector<float>& f, uint64_t texels, Planes& planes) const;

  /// Decorrelated color axes: eigenvectors of the mean outer product of companded colors, strongest first.
  Mat3 decorrelate();
  void set_axes(const Mat3& axes) { axes_ = axes; }

  /// Sums of squares of the companded values read by decorrelate(), [view][light] of a complete layout.
  const std::vector<double>& energies() const { return energies_; }

  uint32_t views() const { return static_cast<uint32_t>(btf_.layout().views().size()); }
  uint64_t not_finite() const { return not_finite_; }

 private:
  const BtfMeasurement& btf_;
  Companding companding_;
  int threads_;
  const Progress& progress_;
  Mat3 axes_{1.0f};
  std::vector<HalfBits> halves_;
  std::vector<double> energies_;
  uint64_t not_finite_ = 0;  // in the last pass over the views
};

// The part of a BTF that is seen from one side of the plane under light from one side.

/// Views and lights of a side, mirrored to z > 0.
struct SideDirections {
  bool view_below = false, light_below = false;
  std::vector<uint32_t> view_number, light_number;  // in the layout
  std::vector<Vec3> view, light;
};

/// The sides for which a complete layout has directions; reflection from above comes first.
std::vector<SideDirections> sides_of(const PairLayout& layout);

/// One level of the images of a view, companded, along the three color axes.
struct LevelImages {
  uint32_t width, height;
  std::array<RowMatrix, 3> value;  // texel x light
};

/// Reads the finest `levels` levels of a view of a side.
void read_side_view(CompandedViews& views, const TexelGrid& grid, const SideDirections& side, size_t view,
                    size_t levels, std::vector<LevelImages>& images);

/// Reduces images, [image][row][column][channel], to the next mip level.
std::vector<float> halved_images(const std::vector<float>& f, uint32_t width, uint32_t height);

}  // namespace velour
