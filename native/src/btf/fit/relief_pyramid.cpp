#include "btf/fit/relief_pyramid.h"

#include <algorithm>

#include "base/parallel.h"
#include "btf/model/srbf_btf.h"
#include "image/texels.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

/// Heights over the reference plane, in tile widths, positive on the viewer's side.
std::vector<float> heights_of(const BtfMeasurement& measurement, const SideDirections& side) {
  std::vector<float> heights(measurement.grid().texels(), 0.0f);
  if (!measurement.has_structure() || !measurement.shell()) return heights;
  const auto normal =
      std::max_element(side.view.begin(), side.view.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  const auto view = side.view_number[static_cast<size_t>(normal - side.view.begin())];
  const ViewStructure structure = measurement.read_structure(view).value();
  const double width = measurement.grid().tile_metres ? static_cast<double>(measurement.grid().tile_metres->x) : 1.0;
  const Shell& shell = *measurement.shell();
  const double sign = side.view_below ? -1 : 1;
  for (size_t t = 0; t < heights.size(); ++t) {
    const bool met = structure.coverage[t] > 0 && std::isfinite(structure.height_mean[t]);
    const double lowest = side.view_below ? shell.thickness : 0.0;
    const double height = met ? static_cast<double>(structure.height_mean[t]) : lowest;
    heights[t] = static_cast<float>(sign * (height - shell.reference_height) / width);
  }
  return heights;
}

/// All levels of a relief with these heights on the finest one.
std::vector<Relief> pyramid_of(const TexelGrid& grid, std::vector<float> heights) {
  std::vector<Relief> pyramid;
  uint32_t width = grid.width, height = grid.height;
  for (;;) {
    std::vector<HalfBits> halves(heights.size());
    floats_to_halves(heights, halves);
    std::vector<float> stored(heights.size());
    halves_to_floats(halves, stored);
    pyramid.emplace_back(width, height, stored, tile_aspect(grid));
    if (width == 1 && height == 1) return pyramid;
    heights = half_image(heights, width, height, 1);
    width = half_of(width);
    height = half_of(height);
  }
}

}  // namespace

std::vector<Relief> relief_pyramid(const BtfMeasurement& measurement, const SideDirections& side) {
  return pyramid_of(measurement.grid(), heights_of(measurement, side));
}

std::vector<Relief> plane_pyramid(const TexelGrid& grid) {
  return pyramid_of(grid, std::vector<float>(grid.texels(), 0.0f));
}

std::vector<HalfBits> stored_heights(const Relief& relief) {
  std::vector<HalfBits> halves(relief.heights().size());
  floats_to_halves(relief.heights(), halves);
  return halves;
}

ReliefGap::ReliefGap(const TensorSource& source, size_t pixels, const Progress& progress)
    : source_(source), progress_(progress) {
  if (is_plane(source.relief[0])) return;
  pixel_ = random_texels(source.grid.texels(), pixels, source.seed);
  squares_.resize(pixel_.size());
}

void ReliefGap::add_view(Index view, const LevelImages& images) {
  const Relief& relief = source_.relief[0];
  const Vec3& wv = source_.side.view[static_cast<size_t>(view)];
  const Vec2 size(relief.width(), relief.height());
  parallel_pieces(pixel_.size(), source_.threads, progress_, [&](size_t i) {
    const Vec2 place = (Vec2(pixel_[i] % relief.width(), pixel_[i] / relief.width()) + 0.5f) / size;
    const BilinearTexels seen = bilinear_at(relief.seen_texel(place, wv), relief.width(), relief.height());
    const std::vector<uint32_t> texels(seen.index.begin(), seen.index.end());
    const auto shown = shown_texels(relief, texels, wv, tile_aspect(source_.grid), 1, progress_);
    float weight = 0;
    for (size_t k = 0; k < 4; ++k) weight += shown[k].shown ? seen.weight[k] : 0.0f;
    if (weight == 0) return;  // other views show what is there
    for (const RowMatrix& image : images.value) {
      Eigen::RowVectorXf rest = image.row(pixel_[i]);
      squares_[i].image += static_cast<double>(rest.squaredNorm());
      for (size_t k = 0; k < 4; ++k) {
        if (shown[k].shown) rest -= seen.weight[k] / weight * blended(image, shown[k].at);
      }
      squares_[i].difference += static_cast<double>(rest.squaredNorm());
    }
  });
}

double ReliefGap::share() const {
  Squares sum;
  for (const Squares& s : squares_) {
    sum.difference += s.difference;
    sum.image += s.image;
  }
  return sum.image > 0 ? sum.difference / sum.image : 0.0;
}

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
