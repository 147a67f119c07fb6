#include "brdf/formats/window_bsdf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "brdf/formats/bsdf_xml.h"
#include "brdf/measure/measurement.h"
#include "brdf/measure/spectrum.h"
#include "math/sphere/vec.h"

namespace velour {

namespace {

// Functions over the unit cube of three or four dimensions as a tree of cells: the variable-resolution BSDFs of
// Radiance [WKB12].

/// A node halves every side of its cube (2^n branches; bit i of a branch's index selects the half of dimension i), or
/// is a grid of 2^k cells per side (the last dimension varies fastest). Constant within a cell.
class TensorTree {
 public:
  /// Reads "{ {1 2 3 ...} {...} ... }": a node is its branches or its grid's numbers in braces, separated by commas or
  /// white space. Numbers beyond a float's range become infinity or 0. Throws Error(bad_data) that begins with `where`.
  TensorTree(std::string_view text, int dimensions, const std::string& where);

  /// Value at a point of [0, 1]^n; 1 belongs to the last cell.
  float at(std::span<const float> place) const;

  int dimensions() const { return dimensions_; }
  /// The values of all cells, in the order of the file.
  std::span<const float> values() const { return values_; }
  /// The smallest cells are 2^-this wide.
  int finest_level() const { return finest_level_; }

 private:
  class Reader;
  struct Grid {
    uint32_t first;  // in `values_`
    int32_t level;   // 2^level cells per side
  };
  // A node >= 0 is the index of its first branch in `branches_`; a node < 0 is the grid ~node.
  int32_t root_ = 0;
  int dimensions_;
  int finest_level_ = 0;
  std::vector<int32_t> branches_;
  std::vector<Grid> grids_;
  std::vector<float> values_;
};

constexpr int kMaxLevels = 16;  // Radiance's own trees have eight

class TensorTree::Reader {
 public:
  Reader(std::string_view text, TensorTree& tree, const std::string& where) : rest_(text), tree_(tree), where_(where) {}

  void read() {
    tree_.root_ = node(0);
    skip_separators(rest_);
    if (!rest_.empty()) fail("continues after the last brace of the tree");
  }

 private:
  int32_t node(int level) {
    if (level > kMaxLevels) fail("is deeper than " + std::to_string(kMaxLevels) + " levels");
    if (!take('{')) fail("lacks '{'");
    skip_separators(rest_);
    const int32_t made = rest_.starts_with('{') ? branches(level) : grid(level);
    if (!take('}')) fail("lacks '}'");
    return made;
  }

  int32_t branches(int level) {
    std::array<int32_t, 16> made{};
    const size_t count = size_t{1} << tree_.dimensions_;
    for (size_t i = 0; i < count; ++i) made[i] = node(level + 1);
    const auto first = static_cast<int32_t>(tree_.branches_.size());
    tree_.branches_.insert(tree_.branches_.end(), made.begin(), made.begin() + static_cast<ptrdiff_t>(count));
    return first;
  }

  int32_t grid(int level) {
    const size_t first = tree_.values_.size();
    while (const auto value = next_number(rest_)) tree_.values_.push_back(*value);
    const size_t count = tree_.values_.size() - first;
    const int bits = static_cast<int>(std::bit_width(count)) - 1;
    if (!std::has_single_bit(count) || bits % tree_.dimensions_ != 0) {
      fail("has a cell of " + std::to_string(count) + " values instead of 1, " +
           std::to_string(1 << tree_.dimensions_) + ", " + std::to_string(1 << 2 * tree_.dimensions_) + ", ...");
    }
    const int own = bits / tree_.dimensions_;
    tree_.finest_level_ = std::max(tree_.finest_level_, level + own);
    tree_.grids_.push_back({static_cast<uint32_t>(first), own});
    return ~static_cast<int32_t>(tree_.grids_.size() - 1);
  }

  bool take(char brace) {
    skip_separators(rest_);
    if (!rest_.starts_with(brace)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const {
    const std::string found = rest_.empty() ? " at the end of the data" : " at '" + next_word(rest_) + "'";
    throw Error(Status::bad_data, where_ + " " + what + found + ".");
  }

  std::string_view rest_;
  TensorTree& tree_;
  const std::string& where_;
};

TensorTree::TensorTree(std::string_view text, int dimensions, const std::string& where) : dimensions_(dimensions) {
  Reader(text, *this, where).read();
}

float TensorTree::at(std::span<const float> place) const {
  std::array<float, 4> p{};
  std::copy(place.begin(), place.end(), p.begin());
  const auto dimensions = static_cast<size_t>(dimensions_);
  int32_t node = root_;
  while (node >= 0) {
    size_t branch = 0;
    for (size_t i = 0; i < dimensions; ++i) {
      p[i] *= 2;
      const bool upper = p[i] >= 1;
      branch |= static_cast<size_t>(upper) << i;
      p[i] -= static_cast<float>(upper);
    }
    node = branches_[static_cast<size_t>(node) + branch];
  }
  const Grid& grid = grids_[static_cast<size_t>(~node)];
  const int cells = 1 << grid.level;
  size_t cell = 0;
  for (size_t i = 0; i < dimensions; ++i) {
    const int along = std::clamp(static_cast<int>(p[i] * static_cast<float>(cells)), 0, cells - 1);
    cell = cell << grid.level | static_cast<size_t>(along);
  }
  return values_[grid.first + cell];
}

/// Shirley and Chiu's equal-area map [SC97] of the unit disk to the unit square.
Vec2 square_of_disk(const Vec2& disk) {
  constexpr float kQuarter = kPi / 4;
  const float r = std::min(std::sqrt(disk.x * disk.x + disk.y * disk.y), 1.0f);
  if (r == 0) return Vec2(0.5f);
  Vec2 square;  // in [-1, 1]
  if (std::abs(disk.x) >= std::abs(disk.y)) {
    square.x = std::copysign(r, disk.x);
    square.y = square.x * std::atan(disk.y / disk.x) / kQuarter;
  } else {
    square.y = std::copysign(r, disk.y);
    square.x = square.y * std::atan(disk.x / disk.y) / kQuarter;
  }
  return 0.5f * square + 0.5f;
}

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
