#include "compress/scene_btf.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "image/half_image.h"

namespace velour {
namespace {

/// The largest angle, in radians, between a direction and the one nearest to it.
double widest_gap(const std::vector<Vec3>& directions) {
  double widest = 0;
  for (const Vec3& a : directions) {
    float nearest = -1;
    for (const Vec3& b : directions) {
      if (a != b) nearest = std::max(nearest, glm::dot(a, b));
    }
    widest = std::max(widest, std::acos(std::clamp(static_cast<double>(nearest), -1.0, 1.0)));
  }
  return widest;
}

class SceneBtf final : public BtfMeasurement {
 public:
  SceneBtf(const BtfMeasurement& fine, uint32_t halvings, std::vector<uint32_t> views)
      : fine_(fine), halvings_(halvings), view_(std::move(views)) {
    std::vector<PolarAngles> angles;
    for (const uint32_t view : view_) angles.push_back(fine.layout().views()[view]);
    layout_ = PairLayout(std::move(angles), fine.layout().lights());
    grid_ = fine.grid();
    shell_ = fine.shell();
    provenance_ = fine.provenance();
    for (uint32_t i = 0; i < halvings; ++i) {
      grid_.width = half_of(grid_.width);
      grid_.height = half_of(grid_.height);
    }
  }

  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    check_range(first, count);
    const size_t fine = fine_.grid().texels() * 3, coarse = grid_.texels() * 3;
    std::vector<HalfBits> halves(fine);
    std::vector<float> floats(fine);
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t pair = first + i;
      fine_.read_pairs(fine_.layout().first(view_[layout_->view_of(pair)]) + layout_->light_of(pair), 1, halves);
      halves_to_floats(halves, floats);
      floats_to_halves(halved_image(floats, fine_.grid(), 3, halvings_), values.subspan(i * coarse, coarse));
    }
  }

  bool has_structure() const override { return fine_.has_structure(); }
  /// Heights are those of what is there: holes count nothing.
  std::optional<ViewStructure> read_structure(uint32_t view) const override {
    auto structure = fine_.read_structure(view_[view]);
    if (structure) coarsen(*structure);
    return structure;
  }

 private:
  void coarsen(ViewStructure& s) const {
    for (size_t i = 0; i < s.coverage.size(); ++i) {
      s.height_spread[i] =
          s.coverage[i] * (s.height_spread[i] * s.height_spread[i] + s.height_mean[i] * s.height_mean[i]);
      s.height_mean[i] *= s.coverage[i];
    }
    for (auto* image : {&s.coverage, &s.height_mean, &s.height_spread}) {
      *image = halved_image(std::move(*image), fine_.grid(), 1, halvings_);
    }
    for (size_t i = 0; i < s.coverage.size(); ++i) {
      const float whole = s.coverage[i] > 0 ? 1 / s.coverage[i] : 0.0f;
      const float mean = s.height_mean[i] *= whole;
      s.height_spread[i] = std::sqrt(std::max(whole * s.height_spread[i] - mean * mean, 0.0f));
    }
  }

  const BtfMeasurement& fine_;
  const uint32_t halvings_;
  const std::vector<uint32_t> view_;
};

}  // namespace

std::vector<uint32_t> views_around(const PairLayout& layout, const ViewRange& range) {
  std::vector<Vec3> directions;
  for (const PolarAngles& angles : layout.views()) directions.push_back(unit_direction(angles));
  const double gap = 2 * widest_gap(directions) + 1e-3;
  std::vector<uint32_t> views;
  for (uint32_t v = 0; v < directions.size(); ++v) {
    const double theta = std::acos(std::min(1.0, std::abs(static_cast<double>(directions[v].z))));
    if (range.whole() || (theta >= range.first() - gap && theta <= range.last() + gap)) views.push_back(v);
  }
  return views;
}

std::unique_ptr<const BtfMeasurement> scene_btf(const BtfMeasurement& fine, uint32_t halvings,
                                                std::vector<uint32_t> views) {
  return std::make_unique<const SceneBtf>(fine, halvings, std::move(views));
}

std::vector<float> halved_image(std::vector<float> image, TexelGrid grid, uint32_t channels, uint32_t halvings) {
  for (; halvings > 0; --halvings) {
    image = half_image(image, grid.width, grid.height, channels);
    grid.width = half_of(grid.width);
    grid.height = half_of(grid.height);
  }
  return image;
}

}  // namespace velour
