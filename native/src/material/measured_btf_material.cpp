#include "material/measured_btf_material.h"

#include "material/cosine_btf_material.h"
#include "material/texel_taps.h"

namespace velour {
namespace {

class MeasuredBtfMaterial final : public CosineBtfMaterial {
 public:
  MeasuredBtfMaterial(std::shared_ptr<const BtfTable> table, BtfLight light)
      : CosineBtfMaterial(light), table_(std::move(table)), two_sided_(table_->between.has_lower_side()) {}

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    BtfTablePoint& p = point.btf_table;
    p.count = 0;
    p.back = site.back && two_sided_;
    const auto views = table_->between.view(turned(wv, p.back));
    if (!views) return;
    visit_texels(site, table_->levels, [&](size_t level, uint64_t texel, float share) {
      for (size_t v = 0; v < 3; ++v) {
        const float weight = share * views->weight[v];
        if (weight > 0) p.row[static_cast<size_t>(p.count++)] = {table_->row(level, views->index[v], texel), weight};
      }
    });
  }

  Vec2 texels() const override { return Vec2(table_->levels[0].width, table_->levels[0].height); }

 private:
  Rgb value(const PreparedBrdf& point, const Vec3& wl) const override {
    const BtfTablePoint& p = point.btf_table;
    const auto lights = wl.z > 0 ? table_->between.light(turned_light(wl, p.back)) : std::nullopt;
    if (!lights) return Rgb(0.0f);
    Rgb sum(0.0f);
    for (int i = 0; i < p.count; ++i) {
      const BtfTablePoint::Row& row = p.row[static_cast<size_t>(i)];
      for (size_t l = 0; l < 3; ++l) sum += row.weight * lights->weight[l] * color(row.lights, lights->index[l]);
    }
    return glm::max(sum, Rgb(0.0f));
  }

  static Rgb color(const HalfBits* lights, uint32_t light) {
    const HalfBits* rgb = lights + 3 * size_t{light};
    return {finite_half_to_float(rgb[0]), finite_half_to_float(rgb[1]), finite_half_to_float(rgb[2])};
  }

  std::shared_ptr<const BtfTable> table_;
  bool two_sided_;
};

}  // namespace

std::shared_ptr<const Material> make_measured_btf_material(std::shared_ptr<const BtfTable> table, BtfLight light) {
  return std::make_shared<MeasuredBtfMaterial>(std::move(table), light);
}

}  // namespace velour
