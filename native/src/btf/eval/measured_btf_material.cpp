#include "btf/eval/measured_btf_material.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include "base/error.h"
#include "btf/measure/btf_measurement.h"
#include "btf/model/factored_btf.h"
#include "image/texels.h"
#include "material/surface_site.h"

namespace velour {

namespace {

class MeasuredBtfMaterial final : public CosineBtfMaterial {
 public:
  MeasuredBtfMaterial(std::shared_ptr<const BtfTable> table, BtfLight light)
      : CosineBtfMaterial(light), table_(std::move(table)), two_sided_(table_->between.has_lower_side()) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  Vec2 texels() const override { return Vec2(table_->levels[0].width, table_->levels[0].height); }

  const BtfTable& table() const { return *table_; }
  bool two_sided() const { return two_sided_; }

 private:
  std::shared_ptr<const BtfTable> table_;
  bool two_sided_;
};

class PreparedMeasuredBtf final : public PreparedCosineBtf {
 public:
  PreparedMeasuredBtf(const MeasuredBtfMaterial& material, const Vec3& wv, const SurfaceSite& site)
      : material_(material), back_(site.back && material.two_sided()) {
    const BtfTable& table = material.table();
    const auto views = table.between.view(material.turned(wv, back_));
    if (!views) return;
    visit_texels(site, table.levels, [&](size_t level, uint64_t texel, float share) {
      for (size_t v = 0; v < 3; ++v) {
        const float weight = share * views->weight[v];
        if (weight > 0) row_[count_++] = {table.row(level, views->index[v], texel), weight};
      }
    });
  }

 private:
  /// Footprint taps, two levels, four texels, three views.
  static constexpr size_t kMaxRows = size_t{FootprintTaps::kMost} * 2 * 4 * 3;
  struct Row {
    const HalfBits* lights;  // [light][channel]
    float weight;
  };

  Rgb value(const Vec3& wl) const override {
    const auto lights = wl.z > 0 ? material_.table().between.light(material_.turned_light(wl, back_)) : std::nullopt;
    if (!lights) return Rgb(0.0f);
    Rgb sum(0.0f);
    for (const Row& row : std::span(row_.data(), count_)) {
      for (size_t l = 0; l < 3; ++l) sum += row.weight * lights->weight[l] * color(row.lights, lights->index[l]);
    }
    return glm::max(sum, Rgb(0.0f));
  }

  static Rgb color(const HalfBits* lights, uint32_t light) {
    const HalfBits* rgb = lights + 3 * size_t{light};
    return {finite_half_to_float(rgb[0]), finite_half_to_float(rgb[1]), finite_half_to_float(rgb[2])};
  }

  const MeasuredBtfMaterial& material_;
  bool back_;
  size_t count_ = 0;
  std::array<Row, kMaxRows> row_;  // rows of lights to blend, and their weights
};

const PreparedBrdf* MeasuredBtfMaterial::prepare(const Vec3& wv, const SurfaceSite& site,
                                                 const PrepareOptions& /*options*/, ScratchArena& arena) const {
  return arena.make<PreparedMeasuredBtf>(*this, wv, site);
}

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
