#include "btf/fit/surface_points.h"

#include "btf/model/srbf_btf.h"
#include "image/bilinear_texels.h"
#include "math/sphere/random.h"

namespace velour {
namespace {

constexpr float kSeenWithin = 0.75f;  // texels

float interpolated_height(const Relief& relief, const BilinearTexels& texels) {
  float height = 0;
  for (size_t i = 0; i < 4; ++i)
    height += texels.weight[i] * relief.height_of(texels.index[i] % relief.width(), texels.index[i] / relief.width());
  return height;
}

/// Collects the values of points view by view.
class PointSampler {
 public:
  PointSampler(const TexelGrid& grid, const SideDirections& side, const Relief& relief,
               const SurfacePointOptions& options)
      : grid_(grid), side_(side), relief_(relief), options_(options), points_(options.points) {
    share_ = static_cast<float>(options.pairs) / static_cast<float>(side.view.size() * side.light.size());
    for (uint32_t i = 0; i < options.points; ++i) {
      RandomStream random(options.seed, i, 0);
      SurfacePoint& point = points_[i];
      point.place = random.next2();
      const BilinearTexels texels = texels_at(point.place);
      point.to_normal = to_normal(relief.slope(texels));
      height_.push_back(interpolated_height(relief, texels));
    }
  }

  void add_view(size_t view, const LevelImages& images) {
    for (uint32_t i = 0; i < options_.points; ++i) add_view(view, images, i);
  }

  std::vector<SurfacePoint> take() { return std::move(points_); }

 private:
  BilinearTexels texels_at(const Vec2& place) const {
    return bilinear_texels(place, relief_.width(), relief_.height());
  }

  void add_view(size_t view, const LevelImages& images, uint32_t i) {
    SurfacePoint& point = points_[i];
    const Vec3& wv = side_.view[view];
    const std::optional<Vec2> shown = shown_at(relief_, point.place, height_[i], tile_aspect(grid_), wv);
    if (!shown) return;
    const BilinearTexels texels = texels_at(*shown);
    RandomStream random(options_.seed, i, 1 + view);
    for (size_t l = 0; l < side_.light.size(); ++l) {
      if (random.next() >= share_) continue;
      point.pair.emplace_back(DirectionPair{side_.light[l], wv});
      for (size_t a = 0; a < 3; ++a) {
        float value = 0;
        for (size_t c = 0; c < 4; ++c) {
          value += texels.weight[c] * images.value[a](texels.index[c], static_cast<Eigen::Index>(l));
        }
        point.value[a].push_back(value);
      }
    }
  }

  const TexelGrid& grid_;
  const SideDirections& side_;
  const Relief& relief_;
  const SurfacePointOptions& options_;
  float share_;
  std::vector<SurfacePoint> points_;
  std::vector<float> height_;
};

}  // namespace

std::optional<Vec2> shown_at(const Relief& relief, const Vec2& place, float height, float aspect, const Vec3& wv) {
  const Vec2 on_plane = place - height / wv.z * Vec2(wv.x, wv.y / aspect);
  const Vec2 size(relief.width(), relief.height());
  if (glm::length((relief.seen(on_plane, wv) - place) * size) > kSeenWithin) return std::nullopt;
  return on_plane;
}

std::vector<SurfacePoint> surface_points(CompandedViews& views, const TexelGrid& grid, const SideDirections& side,
                                         const Relief& relief, const SurfacePointOptions& options, Progress& progress) {
  PointSampler sampler(grid, side, relief, options);
  std::vector<LevelImages> images;
  for (size_t v = 0; v < side.view.size(); ++v) {
    progress.check();
    read_side_view(views, grid, side, v, 1, images);
    sampler.add_view(v, images[0]);
    progress.update(static_cast<double>(v + 1) / static_cast<double>(side.view.size()));
  }
  return sampler.take();
}

}  // namespace velour
