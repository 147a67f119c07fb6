#include "capture/goniometer/height_field.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "math/sphere/random.h"

namespace velour {

namespace {

using Complex = std::complex<double>;

/// Real and imaginary part: two independent standard normal numbers (Box and Muller 1958).
Complex normal_pair(RandomStream& random) {
  const double radius = std::sqrt(-2.0 * std::log1p(-static_cast<double>(random.next())));
  return std::polar(radius, 2.0 * kPiD * static_cast<double>(random.next()));
}

/// Amplitudes of one axis: the square root of the power spectrum exp(-(k correlation)^2 / 4), scaled so that the
/// variances of all modes add up to 1 (the two axes multiply).
std::vector<double> mode_amplitudes(int cells, double correlation) {
  std::vector<double> amplitude(static_cast<size_t>(cells));
  double variance = 0;
  for (int i = 0; i < cells; ++i) {
    const double k = 2.0 * kPiD * std::min(i, cells - i) / cells;
    const double power = std::exp(-0.25 * k * k * correlation * correlation);
    amplitude[static_cast<size_t>(i)] = std::sqrt(power);
    variance += power;
  }
  for (double& a : amplitude) a /= std::sqrt(variance);
  return amplitude;
}

/// Inverse-transforms every row without scaling, then transposes.
void transform_rows(int cells, std::vector<Complex>& grid, Eigen::FFT<double>& fft) {
  const auto n = static_cast<size_t>(cells);
  std::vector<Complex> row(n), out(n), transposed(grid.size());
  for (size_t y = 0; y < n; ++y) {
    std::copy_n(grid.begin() + static_cast<ptrdiff_t>(y * n), n, row.begin());
    fft.inv(out, row);
    for (size_t x = 0; x < n; ++x) transposed[x * n + y] = out[x];
  }
  grid.swap(transposed);
}

}  // namespace

std::vector<double> gaussian_field(int cells, double correlation, uint64_t seed, uint64_t stream) {
  const auto n = static_cast<size_t>(cells);
  const std::vector<double> amplitude = mode_amplitudes(cells, correlation);
  std::vector<Complex> grid(n * n);
  for (size_t y = 0; y < n; ++y) {
    for (size_t x = 0; x < n; ++x) {
      RandomStream random(seed, stream, y * n + x);
      grid[y * n + x] = amplitude[x] * amplitude[y] * normal_pair(random);
    }
  }
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  transform_rows(cells, grid, fft);
  transform_rows(cells, grid, fft);
  // The modes lack Hermitian symmetry; the real part alone has the desired autocorrelation.
  std::vector<double> field(n * n);
  std::transform(grid.begin(), grid.end(), field.begin(), [](const Complex& c) { return c.real(); });
  return field;
}

HeightField make_height_field(const HeightFieldOptions& options, uint64_t seed, uint64_t stream) {
  const std::vector<double> field = gaussian_field(options.cells, options.correlation, seed, stream);
  HeightField surface{options.cells, options.anisotropy, std::vector<float>(field.begin(), field.end())};
  double sum_sq = 0;
  for (int y = 0; y < options.cells; ++y) {
    for (int x = 0; x < options.cells; ++x) {
      const float along_x = surface.at(x + 1, y) - surface.at(x, y), along_y = surface.at(x, y + 1) - surface.at(x, y);
      sum_sq += static_cast<double>(along_x * along_x + along_y * along_y);
    }
  }
  // Makes the average of the two mean squares alpha^2 / 2.
  const auto scale = static_cast<float>(options.roughness * std::sqrt(static_cast<double>(field.size()) / sum_sq));
  for (float& h : surface.height) h *= scale;
  return surface;
}

std::vector<uint8_t> make_patches(int cells, double correlation, double share, uint64_t seed, uint64_t stream) {
  const std::vector<double> field = gaussian_field(cells, correlation, seed, stream);
  std::vector<uint32_t> order(field.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto marked = static_cast<ptrdiff_t>(std::lround(share * static_cast<double>(field.size())));
  std::nth_element(order.begin(), order.begin() + marked, order.end(),
                   [&field](uint32_t a, uint32_t b) { return field[a] != field[b] ? field[a] > field[b] : a < b; });
  std::vector<uint8_t> patches(field.size(), 0);
  for (ptrdiff_t i = 0; i < marked; ++i) patches[order[static_cast<size_t>(i)]] = 1;
  return patches;
}

namespace {

/// Number of cells that the mesh repeats beyond each side of the period, so that no ray slips through the seam.
constexpr int kPad = 1;

/// Distance along `direction` to the far side of [0, period].
float distance_to_side(float origin, float direction, float period) {
  if (direction == 0.0f) return std::numeric_limits<float>::infinity();
  return std::max(0.0f, ((direction > 0.0f ? period : 0.0f) - origin) / direction);
}

std::vector<Vec3> padded_positions(const HeightField& field) {
  std::vector<Vec3> positions;
  const int last = field.cells + kPad;
  positions.reserve(static_cast<size_t>(last + kPad + 1) * static_cast<size_t>(last + kPad + 1));
  for (int y = -kPad; y <= last; ++y) {
    for (int x = -kPad; x <= last; ++x) {
      positions.emplace_back(static_cast<float>(x), static_cast<float>(y * field.cell_y), field.at(x, y));
    }
  }
  return positions;
}

/// Two triangles per cell, counterclockwise from above, the one below the diagonal first.
std::vector<glm::uvec3> padded_triangles(int cells) {
  const auto side = static_cast<uint32_t>(cells + 2 * kPad);
  std::vector<glm::uvec3> triangles;
  triangles.reserve(size_t{2} * side * side);
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t v = y * (side + 1) + x;
      triangles.emplace_back(v, v + 1, v + side + 2);
      triangles.emplace_back(v, v + side + 2, v + side + 1);
    }
  }
  return triangles;
}

/// Facet of the period that corresponds to triangle `triangle` of the padded mesh.
int facet_of_triangle(uint32_t triangle, int cells) {
  const int side = cells + 2 * kPad, cell = static_cast<int>(triangle / 2);
  const int x = (cell % side - kPad + cells) % cells, y = (cell / side - kPad + cells) % cells;
  return 2 * (y * cells + x) + static_cast<int>(triangle % 2);
}

}  // namespace

PeriodicTile::PeriodicTile(HeightField field, std::vector<uint8_t> base_cells)
    : field_(std::move(field)), base_cells_(std::move(base_cells)) {
  const auto cells = static_cast<double>(field_.cells);
  period_ = {cells, cells * field_.cell_y};
  top_ = *std::max_element(field_.height.begin(), field_.height.end());
  lift_ = std::max(period_.x, period_.y) * 0x1p-20f;  // a few roundings of the largest coordinate
  const auto triangles = padded_triangles(field_.cells);
  scene_.add_instance(scene_.add_mesh(padded_positions(field_), triangles), {});
  // One thread: tiles are built in parallel, and the BVH must not depend on the number of threads.
  scene_.commit(1, nullptr, EmbreeScene::Levels::one);
}

Vec2 PeriodicTile::slope(int facet) const {
  const int cell = facet / 2, x = cell % field_.cells, y = cell / field_.cells;
  const int row = y + facet % 2, column = x + 1 - facet % 2;
  const float along_x = field_.at(x + 1, row) - field_.at(x, row);
  const float along_y = field_.at(column, y + 1) - field_.at(column, y);
  return {along_x, along_y / static_cast<float>(field_.cell_y)};
}

FacetPoint PeriodicTile::surface_point(int facet, const Vec3& position) const {
  const Vec2 s = slope(facet);
  const Vec3 normal = glm::normalize(Vec3(-s.x, -s.y, 1.0f));
  return {position + lift_ * normal, normal, is_base(facet)};
}

FacetPoint PeriodicTile::point_above(const Vec2& u) const {
  const auto cells = static_cast<float>(field_.cells);
  const Vec2 at = u * cells;
  const int x = std::min(static_cast<int>(at.x), field_.cells - 1);
  const int y = std::min(static_cast<int>(at.y), field_.cells - 1);
  const float in_x = at.x - static_cast<float>(x), in_y = at.y - static_cast<float>(y);
  const int facet = 2 * (y * field_.cells + x) + (in_y > in_x ? 1 : 0);
  const Vec2 s = slope(facet);
  const auto cell_y = static_cast<float>(field_.cell_y);
  return surface_point(facet, {at.x, at.y * cell_y, field_.at(x, y) + s.x * in_x + s.y * in_y * cell_y});
}

bool PeriodicTile::enter_next_period(Ray& ray) const {
  const Vec3& d = ray.direction;
  const float to_x = distance_to_side(ray.origin.x, d.x, period_.x);
  const float to_y = distance_to_side(ray.origin.y, d.y, period_.y);
  const float distance = std::min(to_x, to_y);
  if (std::isinf(distance) || (d.z > 0.0f && ray.origin.z + distance * d.z >= top_)) return false;
  ray.origin += distance * d;
  if (to_x <= to_y) ray.origin.x = d.x > 0.0f ? 0.0f : period_.x;
  if (to_y <= to_x) ray.origin.y = d.y > 0.0f ? 0.0f : period_.y;
  return true;
}

Fate PeriodicTile::trace(const Vec3& origin, const Vec3& direction, FacetPoint& hit) const {
  Ray ray{origin, 0.0f, direction};
  for (int period = 0; period < kMaxPeriods; ++period) {
    Hit found;
    scene_.intersect(ray, found);
    if (found.instance != kNoHit) {
      const int facet = facet_of_triangle(found.triangle, field_.cells);
      hit = surface_point(facet, ray.origin + found.distance * direction);
      return Fate::hit;
    }
    if (!enter_next_period(ray)) return direction.z > 0.0f ? Fate::escaped : Fate::lost;
  }
  return Fate::lost;
}

bool PeriodicTile::escapes(const Vec3& origin, const Vec3& direction) const {
  Ray ray{origin, 0.0f, direction};
  for (int period = 0; period < kMaxPeriods; ++period) {
    if (scene_.occluded(ray)) return false;
    if (!enter_next_period(ray)) return direction.z > 0.0f;
  }
  return false;
}

}  // namespace velour
