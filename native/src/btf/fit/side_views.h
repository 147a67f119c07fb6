// The part of a BTF that is seen from one side of the plane under light from one side.
#pragma once

#include <vector>

#include "btf/fit/companded_views.h"

namespace velour {

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
