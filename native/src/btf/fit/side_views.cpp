#include "btf/fit/side_views.h"

#include "image/half_image.h"

namespace velour {
namespace {

void take_side(const std::vector<PolarAngles>& set, bool below, std::vector<uint32_t>& number,
               std::vector<Vec3>& directions) {
  for (uint32_t i = 0; i < set.size(); ++i) {
    const Vec3 w = unit_direction(set[i]);
    if ((w.z < 0) != below) continue;
    number.push_back(i);
    directions.emplace_back(w.x, w.y, std::abs(w.z));
  }
}

/// Values of the side's lights as texel x light.
RowMatrix by_texel(const RowMatrix& plane, const SideDirections& side) {
  RowMatrix values(plane.cols(), static_cast<Eigen::Index>(side.light.size()));
  for (size_t l = 0; l < side.light.size(); ++l) {
    values.col(static_cast<Eigen::Index>(l)) = plane.row(side.light_number[l]).transpose();
  }
  return values;
}

}  // namespace

std::vector<SideDirections> sides_of(const PairLayout& layout) {
  std::vector<SideDirections> sides;
  for (const bool view_below : {false, true}) {
    for (const bool light_below : {view_below, !view_below}) {
      SideDirections side{view_below, light_below, {}, {}, {}, {}};
      take_side(layout.views(), view_below, side.view_number, side.view);
      take_side(layout.lights(), light_below, side.light_number, side.light);
      if (!side.view.empty() && !side.light.empty()) sides.push_back(std::move(side));
    }
  }
  return sides;
}

std::vector<float> halved_images(const std::vector<float>& f, uint32_t width, uint32_t height) {
  const size_t image = size_t{width} * height * 3, coarse = size_t{half_of(width)} * half_of(height) * 3;
  std::vector<float> out(f.size() / image * coarse);
  for (size_t i = 0; i * image < f.size(); ++i) {
    const std::vector<float> half = half_image({f.data() + i * image, image}, width, height, 3);
    std::copy(half.begin(), half.end(), out.begin() + static_cast<ptrdiff_t>(i * coarse));
  }
  return out;
}

void read_side_view(CompandedViews& views, const TexelGrid& grid, const SideDirections& side, size_t view,
                    size_t levels, std::vector<LevelImages>& images) {
  std::vector<float> f;
  views.read(side.view_number[view], f);
  images.resize(levels);
  CompandedViews::Planes planes;
  uint32_t width = grid.width, height = grid.height;
  for (LevelImages& level : images) {
    level.width = width;
    level.height = height;
    views.planes(f, uint64_t{width} * height, planes);
    for (size_t a = 0; a < 3; ++a) level.value[a] = by_texel(planes[a], side);
    if (&level == &images.back()) break;
    f = halved_images(f, width, height);
    width = half_of(width);
    height = half_of(height);
  }
}

}  // namespace velour
