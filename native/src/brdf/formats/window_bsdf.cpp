#include "brdf/formats/window_bsdf.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "brdf/formats/bsdf_xml.h"
#include "brdf/formats/tensor_tree.h"
#include "brdf/measure/entries.h"
#include "brdf/measure/spectrum.h"

namespace velour {
namespace {

constexpr float kBelowHalf = 0x1.fffffep-2f;
constexpr const char* kSides[] = {"Reflection Front", "Reflection Back"};

/// f as [patch of the view][patch of the light].
class KlemsMeasurement final : public Measurement {
 public:
  KlemsMeasurement(KlemsBasis light, KlemsBasis view, std::vector<Rgb> f, std::vector<uint8_t> valid,
                   Provenance provenance, const EntryCounts& counts, std::string side)
      : light_(std::move(light)),
        view_(std::move(view)),
        f_(std::move(f)),
        valid_(std::move(valid)),
        side_(std::move(side)) {
    provenance_ = std::move(provenance);
    counts_ = counts;
  }

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    const auto viewers = view_.around(wv);
    for (size_t i = 0; i < wl.size(); ++i) {
      f[i] = Rgb(0);
      float weights = 0;
      if (wv.z > 0 && wl[i].z > 0) {
        // Incident directions are indexed by where the light goes, so a mirror direction has the light's index.
        for (const auto& light : light_.around(Vec3(-wl[i].x, -wl[i].y, wl[i].z))) {
          for (const auto& viewer : viewers) {
            const size_t entry = size_t{viewer.patch} * light_.patches() + light.patch;
            const float weight = light.weight * viewer.weight;
            if (!valid_[entry]) continue;
            f[i] += weight * f_[entry];
            weights += weight;
          }
        }
      }
      valid[i] = weights > 1e-6f;
      if (valid[i]) f[i] /= weights;
    }
  }

  bool isotropic() const override { return false; }
  bool covers_view(float /*theta_v*/) const override { return true; }

  std::vector<std::pair<std::string, std::string>> details() const override {
    return {{"table", std::to_string(light_.patches()) + " light directions x " + std::to_string(view_.patches()) +
                          " view directions, in rings"},
            {"holds", "f without cosine, 1/sr, " + side_},
            {"invalid", "entries that are not finite or have negative luminance"},
            {"interpolation", "linear between patch centers, in polar angle and azimuth"}};
  }

 private:
  const KlemsBasis light_, view_;
  const std::vector<Rgb> f_;
  const std::vector<uint8_t> valid_;
  const std::string side_;
};

/// f over a tree's coordinates: two of the light (or its angle alone) and two of the view.
class TreeMeasurement final : public Measurement {
 public:
  struct Trees {
    TensorTree y;
    std::optional<TensorTree> u, v;  // CIE 1976 chromaticities
  };

  TreeMeasurement(Trees trees, Provenance provenance, const EntryCounts& counts, std::string side)
      : trees_(std::move(trees)), side_(std::move(side)) {
    provenance_ = std::move(provenance);
    counts_ = counts;
  }

  void eval(const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    const Vec2 viewer = square_of_disk(Vec2(wv));
    for (size_t i = 0; i < wl.size(); ++i) {
      f[i] = Rgb(0);
      valid[i] = 0;
      if (!(wv.z > 0 && wl[i].z > 0)) continue;
      // Incident directions are indexed by where the light goes, so a mirror direction has the light's index.
      const Vec2 light(-wl[i].x, -wl[i].y);
      if (isotropic()) {
        const float sine = glm::length(light);
        const Vec2 x = sine > 0 ? light / sine : Vec2(1, 0);
        const Vec2 turned = square_of_disk({x.x * wv.x + x.y * wv.y, x.x * wv.y - x.y * wv.x});
        // From 0 at the horizon to 0.5 at the normal: the cube's other half is not used.
        const float place[] = {std::clamp(0.5f - 0.5f * sine, 0.0f, kBelowHalf), turned.x, turned.y};
        valid[i] = value(place, f[i]);
      } else {
        const Vec2 square = square_of_disk(light);
        const float place[] = {square.x, square.y, viewer.x, viewer.y};
        valid[i] = value(place, f[i]);
      }
    }
  }

  bool isotropic() const override { return trees_.y.dimensions() == 3; }
  bool covers_view(float /*theta_v*/) const override { return true; }

  std::vector<std::pair<std::string, std::string>> details() const override {
    return {{"table", "a tree of " + std::to_string(trees_.y.values().size()) + " cells, the smallest 1/" +
                          std::to_string(1 << trees_.y.finest_level()) +
                          " of the side of the square that maps to the hemisphere"},
            {"holds", "f without cosine, 1/sr, " + side_},
            {"invalid", "cells that are negative or not finite"},
            {"interpolation", "none: constant within a cell, as in Radiance"}};
  }

 private:
  bool value(std::span<const float> place, Rgb& f) const {
    const float y = trees_.y.at(place);
    Rgb found(y);
    if (trees_.u && trees_.v) {
      const double u = trees_.u->at(place), v = trees_.v->at(place);
      found = rec709_of_xyz(static_cast<double>(y) * Vec3d(9 * u / (4 * v), 1, (12 - 3 * u - 20 * v) / (4 * v)));
    }
    EntryCounts ignored;
    if (!count_entry(found, NegativeRule::luminance, ignored)) return false;
    f = found;
    return true;
  }

  const Trees trees_;
  const std::string side_;
};

/// Values as [patch of the view][patch of the light].
std::vector<float> matrix(const BsdfXml& in, const pugi::xml_node& block, size_t lights, size_t views) {
  std::vector<float> values = in.numbers(block, lights * views);
  if (in.structure() == BsdfXml::Structure::columns) return values;
  std::vector<float> turned(values.size());
  for (size_t light = 0; light < lights; ++light) {
    for (size_t view = 0; view < views; ++view) turned[view * lights + light] = values[light * views + view];
  }
  return turned;
}

std::string said(const char* side, bool in_color) {
  return std::string(side == kSides[0] ? "front side" : "back side") +
         (in_color ? ", color" : ", visible light only (gray)");
}

std::shared_ptr<const Measurement> read_matrix(const BsdfXml& in, const char* side, Provenance provenance) {
  const pugi::xml_node visible = in.block("Visible", side);
  const KlemsBasis &light = in.basis(visible, "ColumnAngleBasis"), &view = in.basis(visible, "RowAngleBasis");
  const size_t lights = light.patches(), views = view.patches();
  const std::vector<float> y = matrix(in, visible, lights, views);
  std::vector<Rgb> f(y.size());
  const pugi::xml_node x_block = in.block("CIE-X", side), z_block = in.block("CIE-Z", side);
  if (x_block && z_block) {
    const std::vector<float> x = matrix(in, x_block, lights, views), z = matrix(in, z_block, lights, views);
    for (size_t i = 0; i < f.size(); ++i) f[i] = rec709_of_xyz(Vec3d(x[i], y[i], z[i]));
  } else {
    for (size_t i = 0; i < f.size(); ++i) f[i] = Rgb(y[i]);
  }
  EntryCounts counts;
  std::vector<uint8_t> valid(f.size());
  for (size_t i = 0; i < f.size(); ++i) valid[i] = count_entry(f[i], NegativeRule::luminance, counts);
  return std::make_shared<KlemsMeasurement>(light, view, std::move(f), std::move(valid), std::move(provenance), counts,
                                            said(side, x_block && z_block));
}

std::shared_ptr<const Measurement> read_tree(const BsdfXml& in, const char* side, Provenance provenance) {
  const int dimensions = in.structure() == BsdfXml::Structure::tree3 ? 3 : 4;
  const auto tree = [&](const char* wavelength) -> std::optional<TensorTree> {
    const pugi::xml_node block = in.block(wavelength, side);
    if (!block) return std::nullopt;
    return TensorTree(in.tree(block), dimensions,
                      provenance.path + ": ScatteringData of " + side + ", " + wavelength + ",");
  };
  TreeMeasurement::Trees trees{*tree("Visible"), tree("CIE-u"), tree("CIE-v")};
  EntryCounts counts;
  for (const float y : trees.y.values()) count_entry(Rgb(y), NegativeRule::luminance, counts);
  const std::string words = said(side, trees.u && trees.v);
  return std::make_shared<TreeMeasurement>(std::move(trees), std::move(provenance), counts, words);
}

}  // namespace

bool looks_like_window_bsdf(std::span<const uint8_t> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  const size_t element = text.find("<WindowElement");
  return element != std::string_view::npos && text.find_first_not_of(" \t\r\n\xef\xbb\xbf") == text.find('<');
}

std::shared_ptr<const Measurement> read_window_bsdf(std::span<const uint8_t> bytes, Provenance provenance) {
  const BsdfXml in(bytes, provenance.path);
  const char* side = in.block("Visible", kSides[0]) ? kSides[0] : kSides[1];
  if (!in.block("Visible", side))
    in.fail(
        "has no reflection data for visible light; Velour does not read transmission data. Use a file with a "
        "reflection block.");
  provenance.format = "window-bsdf";
  provenance.description = in.name();
  using enum BsdfXml::Structure;
  if (in.structure() == columns || in.structure() == rows) return read_matrix(in, side, std::move(provenance));
  return read_tree(in, side, std::move(provenance));
}

}  // namespace velour
