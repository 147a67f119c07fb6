#include "btf/eval/measured_btf_material.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include "base/error.h"
#include "btf/measure/btf_measurement.h"
#include "btf/model/factored_btf.h"
#include "image/half_image.h"
#include "material/footprint_taps.h"

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

namespace {

std::string gigabytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GB", static_cast<double>(bytes) * 1e-9);
  return text;
}

void require_room(const BtfMeasurement& btf, uint64_t most_bytes) {
  const uint64_t bytes = btf.layout().pairs() * pyramid_texels(btf.grid()) * 3 * sizeof(HalfBits);
  if (bytes <= most_bytes) return;
  throw Error(Status::unsupported, btf.provenance().path + ": the uncompressed BTF with its mip levels takes " +
                                       gigabytes(bytes) + " of memory; the limit is " + gigabytes(most_bytes) +
                                       ". Raise the limit, compress the BTF, or capture fewer texels or directions.");
}

void size_levels(const BtfMeasurement& btf, BtfTable& table) {
  uint32_t width = btf.grid().width, height = btf.grid().height;
  for (;; width = half_of(width), height = half_of(height)) {
    const uint64_t values = btf.layout().pairs() * width * height * 3;
    table.levels.push_back({width, height, std::vector<HalfBits>(values)});
    if (width == 1 && height == 1) return;
  }
}

/// Writes `image` and its mip levels to their slots in the table.
void scatter_pyramid(std::vector<float> image, uint32_t view, size_t light, BtfTable& table) {
  std::vector<HalfBits> halves(image.size());
  for (size_t l = 0; l < table.levels.size(); ++l) {
    BtfTable::Level& level = table.levels[l];
    halves.resize(image.size());
    floats_to_halves(image, halves);
    const size_t stride = table.lights * 3;
    HalfBits* to = level.value.data() + view * uint64_t{level.width} * level.height * stride + light * 3;
    for (size_t i = 0; i < halves.size(); i += 3, to += stride) std::copy_n(halves.data() + i, 3, to);
    if (l + 1 < table.levels.size()) image = half_image(image, level.width, level.height, 3);
  }
}

}  // namespace

std::shared_ptr<const BtfTable> read_btf_table(const BtfMeasurement& btf, uint64_t most_bytes) {
  require_room(btf, most_bytes);
  const PairLayout& layout = btf.layout();
  auto table = std::make_shared<BtfTable>(BtfTable{PairInterpolation(layout), layout.lights().size(), {}});
  size_levels(btf, *table);
  const size_t image = btf.grid().texels() * 3;
  std::vector<HalfBits> halves(table->lights * image);
  std::vector<float> floats(image);
  for (uint32_t view = 0; view < layout.views().size(); ++view) {
    btf.read_pairs(layout.first(view), table->lights, halves);
    for (size_t light = 0; light < table->lights; ++light) {
      halves_to_floats({halves.data() + light * image, image}, floats);
      mend_image(floats);
      scatter_pyramid(floats, view, light, *table);
    }
  }
  return table;
}

}  // namespace velour
