#include "brdf/formats/tensor_tree.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "brdf/formats/bsdf_xml.h"

namespace velour {
namespace {

constexpr int kMaxLevels = 16;  // Radiance's own trees have eight

}  // namespace

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
    const std::string found =
        rest_.empty() ? " at the end of the data" : " at '" + std::string(rest_.substr(0, 12)) + "'";
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

}  // namespace velour
