#include "brdf/fit/direction_tree.h"

#include <algorithm>
#include <cmath>
#include "math/sphere/random.h"

namespace velour {

namespace {

constexpr float kBaseSide = 0.125f;  // side of the largest cells; the whole square has 2
// Sides of the cells at the mirror direction and at the view. A highlight of bandwidth 1e8 is a few of them wide.
constexpr float kFinestMirror = 1e-4f, kFinestRetro = 1e-3f;
constexpr float kFinest = 3e-5f;
constexpr size_t kMaxCells = 16384;
// Cells are joined if the variance of f cos between them is below this share of the view's energy.
constexpr double kFlat = 4e-6;
// Shares of the density of samples.
constexpr double kByEnergy = 0.4, kByLight = 0.4, kEven = 0.2;

/// The point of the disk [-1, 1]^2 that the concentric map takes `p` to, as a direction.
Vec3 direction_at(const Vec2& p) {
  const double a = p.x, b = p.y;
  double r = 0, phi = 0;
  if (std::abs(a) > std::abs(b)) {
    r = a, phi = 0.25 * kPiD * b / a;
  } else if (b != 0) {
    r = b, phi = 0.25 * kPiD * (2 - a / b);
  }
  const double sine = r * std::sqrt(2 - r * r);
  return Vec3(Vec3d(sine * std::cos(phi), sine * std::sin(phi), 1 - r * r));
}

Vec2 place_of(const Vec3& w) {
  const double x = w.x, y = w.y, length_sq = x * x + y * y;
  if (!(length_sq > 0)) return {0, 0};
  // 1 - z without cancellation, for directions on or above the horizon.
  const double z = std::max(static_cast<double>(w.z), 0.0);
  const double r = std::sqrt(z > 0.5 ? length_sq / (1 + z) : 1 - z);
  if (std::abs(x) >= std::abs(y)) {
    const double a = std::copysign(r, x);
    return Vec2(a, a * 4 / kPiD * std::atan(y / x));
  }
  const double b = std::copysign(r, y);
  return Vec2(b * 4 / kPiD * std::atan(x / y), b);
}

/// Distance of `p` from a cell along the farther axis; 0 inside.
float distance_from(const DirectionTree::Cell& cell, const Vec2& p) {
  const auto beyond = [&cell](float low, float at) { return std::max({low - at, at - low - cell.side, 0.0f}); };
  return std::max(beyond(cell.corner.x, p.x), beyond(cell.corner.y, p.y));
}

/// The place of the cell's direction, in its middle three fifths.
Vec2 place_in(const DirectionTree::Cell& cell) {
  const auto bits = [](float x) { return static_cast<uint64_t>(static_cast<int64_t>(std::lround((x + 2) * 0x1p20f))); };
  RandomStream random(bits(cell.side), bits(cell.corner.x), bits(cell.corner.y));
  return cell.corner + cell.side * (0.2f + 0.6f * random.next2());
}

}  // namespace

LightReader reader_of(const Measurement& measurement, const Vec3& wv) {
  return [&measurement, wv](std::span<const Vec3> wl, std::span<LightValue> values) {
    std::vector<Rgb> f(wl.size(), Rgb(0));
    std::vector<uint8_t> valid(wl.size(), 0);
    measurement.eval(wv, wl, f, valid);
    for (size_t i = 0; i < wl.size(); ++i) {
      if (valid[i] && std::isfinite(f[i].r + f[i].g + f[i].b)) values[i] = {.f = f[i], .valid = true};
    }
  };
}

double DirectionTree::Sums::share(const Cell& cell) const {
  const double y = cell.luminance_cos(), solid_angle = cell.solid_angle();
  double sum = 0;
  if (energy > 0) sum += 0.5 * solid_angle * y * y / energy;
  if (light > 0) sum += 0.5 * solid_angle * std::abs(y) / light;
  return sum;
}

DirectionTree::DirectionTree(const LightReader& read, const Vec3& wv, int parts, bool folded) : folded_(folded) {
  plant();
  split_about({-wv.x, -wv.y, wv.z}, kFinestMirror);
  split_about(wv, kFinestRetro);
  read_new(read);
  while (split_bright(read, parts)) {
  }
  const Sums total = sums();
  for (uint32_t root = 0; root < roots_; ++root) join(root, total, parts);
  for (uint32_t root = 0; root < roots_; ++root) list_leaves(root);

  if (!folded_) list_densities();
}

/// Brightness of a leaf for its density: not much darker than its brightest neighbor, because its one direction may lie
/// in the tail of a highlight that enters it elsewhere.
double DirectionTree::brightness(uint32_t leaf) const {
  constexpr double kOfNeighbor = 0.25;
  const Cell& c = cells_[leaf];
  const float side = c.side, beyond = 0.5f * kFinest;
  double most = std::abs(c.luminance_cos());
  const Vec2 middle = c.corner + Vec2(0.5f * side);
  for (const Vec2& towards : {Vec2(-1, 0), Vec2(1, 0), Vec2(0, -1), Vec2(0, 1)}) {
    const Vec2 place = middle + (0.5f * side + beyond) * towards;
    if (std::max(std::abs(place.x), std::abs(place.y)) >= 1) continue;
    most = std::max(most, kOfNeighbor * std::abs(cells_[leaf_of(place)].luminance_cos()));
  }
  return most;
}

/// Probabilities and densities of the leaves.
void DirectionTree::list_densities() {
  leaf_density_.assign(cells_.size(), 0.0f);
  std::vector<double> bright;
  Sums kept;
  for (const uint32_t i : leaves_) {
    const double y = bright.emplace_back(brightness(i)), solid_angle = cells_[i].solid_angle();
    kept.energy += solid_angle * y * y;
    kept.light += solid_angle * y;
  }
  const double by_energy = kept.energy > 0 ? kByEnergy : 0, by_light = kept.light > 0 ? kByLight : 0;
  double running = 0;
  for (size_t k = 0; k < leaves_.size(); ++k) {
    const double y = bright[k], solid_angle = cells_[leaves_[k]].solid_angle();
    double probability = kEven * solid_angle / (2 * kPiD);
    if (by_energy > 0) probability += by_energy * solid_angle * y * y / kept.energy;
    if (by_light > 0) probability += by_light * solid_angle * y / kept.light;
    probability /= kEven + by_energy + by_light;
    leaf_density_[leaves_[k]] = static_cast<float>(probability / solid_angle);
    running_.push_back(running += probability);
  }
}

/// The cells of kBaseSide.
void DirectionTree::plant() {
  if (folded_) {
    cells_ = {{.corner = {-1, 0}, .side = 1}, {.corner = {0, 0}, .side = 1}};
  } else {
    cells_ = {{.corner = {-1, -1}, .side = 2}};
  }
  roots_ = cells_.size();
  for (uint32_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].side > kBaseSide) split(i);
  }
}

void DirectionTree::split(uint32_t index) {
  const Vec2 corner = cells_[index].corner;
  const float side = 0.5f * cells_[index].side;
  cells_[index].first_child = static_cast<int32_t>(cells_.size());
  for (int k = 0; k < 4; ++k) {
    Cell child{.corner = corner + side * Vec2(k % 2, k / 2), .side = side};
    child.wl = direction_at(place_in(child));
    cells_.push_back(child);
  }
}

void DirectionTree::split_about(const Vec3& axis, float finest) {
  Vec2 place = place_of(axis);
  if (folded_) place.y = std::abs(place.y);
  for (uint32_t i = 0; i < cells_.size(); ++i) {  // also those that are split here
    const Cell& c = cells_[i];
    if (c.leaf() && c.side > finest && distance_from(c, place) < 0.5f * c.side) split(i);
  }
}

void DirectionTree::read_new(const LightReader& read) {
  std::vector<uint32_t> fresh;
  std::vector<Vec3> wl;
  for (uint32_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].read || cells_[i].side > kBaseSide) continue;
    fresh.push_back(i);
    wl.push_back(cells_[i].wl);
  }
  std::vector<LightValue> values(wl.size());
  read(wl, values);
  for (size_t i = 0; i < fresh.size(); ++i) {
    cells_[fresh[i]].value = values[i];
    cells_[fresh[i]].read = true;
  }
}

DirectionTree::Sums DirectionTree::sums() const {
  Sums sums;
  for (const Cell& c : cells_) {
    if (!c.leaf() || !c.value.valid) continue;
    const double y = c.luminance_cos();
    sums.energy += c.solid_angle() * y * y;
    sums.light += c.solid_angle() * std::abs(y);
  }
  return sums;
}

bool DirectionTree::split_bright(const LightReader& read, int parts) {
  const Sums total = sums();
  const size_t before = cells_.size();
  std::vector<uint32_t> bright;
  for (uint32_t i = 0; i < before && cells_.size() < kMaxCells; ++i) {
    const Cell& c = cells_[i];
    if (c.leaf() && c.side > kFinest && total.share(c) * parts > 1) bright.push_back(i);
  }
  for (const uint32_t i : bright) {
    if (cells_[i].leaf()) split(i);
    split_neighbors(i);
  }
  if (cells_.size() == before) return false;
  read_new(read);
  return true;
}

/// Splits larger leaves around a bright cell: their one direction may have missed the rest of a narrow highlight.
void DirectionTree::split_neighbors(uint32_t index) {
  const Vec2 corner = cells_[index].corner;
  const float side = cells_[index].side;
  for (int k = 0; k < 9; ++k) {
    const Vec2 place = corner + side * Vec2(static_cast<float>(k % 3) - 0.5f, static_cast<float>(k / 3) - 0.5f);
    if (std::max(std::abs(place.x), std::abs(place.y)) >= 1) continue;
    const uint32_t leaf = leaf_of(place);
    if (cells_[leaf].side > side) split(leaf);
  }
}

/// Joins cells below `index` that were split in vain. Returns whether `index` is a leaf afterwards.
bool DirectionTree::join(uint32_t index, const Sums& sums, int parts) {
  if (cells_[index].leaf()) return true;
  const auto first = static_cast<uint32_t>(cells_[index].first_child);
  bool leaves = true;
  for (uint32_t k = 0; k < 4; ++k) leaves &= join(first + k, sums, parts);
  Cell& c = cells_[index];
  if (!leaves || !c.read || sums.share(c) * parts > 1) return false;
  double variance = 0;
  for (uint32_t k = 0; k < 4; ++k) {
    const Cell& child = cells_[first + k];
    const double difference = child.luminance_cos() - c.luminance_cos();
    variance += child.solid_angle() * difference * difference;
    if (child.value.valid != c.value.valid) return false;
  }
  if (variance > kFlat * sums.energy) return false;
  for (uint32_t k = 0; k < 4; ++k) cells_[first + k].value.valid = false;  // no longer part of the tree
  c.first_child = -1;
  return true;
}

void DirectionTree::list_leaves(uint32_t index) {
  if (cells_[index].leaf()) {
    leaves_.push_back(index);
    return;
  }
  for (uint32_t k = 0; k < 4; ++k) list_leaves(static_cast<uint32_t>(cells_[index].first_child) + k);
}

uint32_t DirectionTree::leaf_of(Vec2 place) const {
  if (folded_) place.y = std::abs(place.y);
  uint32_t index = folded_ && place.x >= 0 ? 1 : 0;
  while (!cells_[index].leaf()) {
    const Cell& c = cells_[index];
    const float half = 0.5f * c.side;
    const uint32_t right = place.x >= c.corner.x + half, up = place.y >= c.corner.y + half;
    index = static_cast<uint32_t>(c.first_child) + right + 2 * up;
  }
  return index;
}

const DirectionTree::Cell& DirectionTree::leaf_at(const Vec3& wl) const { return cells_[leaf_of(place_of(wl))]; }

double DirectionTree::density(const Vec3& wl) const {
  return static_cast<double>(leaf_density_[leaf_of(place_of(wl))]);
}

void DirectionTree::sample(size_t count, uint64_t seed, std::vector<Vec3>& out) const {
  constexpr uint64_t kStream = 0x5eed;
  RandomStream random(seed, kStream, 0);
  const double shift = static_cast<double>(random.next()), turn = static_cast<double>(random.next());
  size_t leaf = 0;
  for (size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + shift) / static_cast<double>(count) * running_.back();
    while (leaf + 1 < leaves_.size() && running_[leaf] <= at) ++leaf;
    const double begin = leaf == 0 ? 0 : running_[leaf - 1];
    const double along = std::clamp((at - begin) / (running_[leaf] - begin), 0.0, 1.0);
    const double across = turn + kGoldenRatio * static_cast<double>(i);
    const Cell& c = cells_[leaves_[leaf]];
    out.push_back(direction_at(c.corner + c.side * Vec2(along, across - std::floor(across))));
  }
}

}  // namespace velour
