// The cells lie in half-vector space, where a highlight stays in place while the view moves, and grow as the fourth
// power from the normal, where it is narrow: 64 rows resolve a lobe of 1e-4 rad. A view between tabulated ones mixes
// the tables about it, and both its samples and its density do so in the same proportions.
#include "material/table_sampler.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "sphere/warp.h"

namespace velour {

namespace {

constexpr int kRows = 64, kColumns = 64;  // of d = 1 - h.z and of the azimuth of h
constexpr int kMeridianViews = 90;
constexpr int kPolarViews = 16, kAzimuthViews = 32;
constexpr int kSubsamples = 2;            // along each side of a cell
constexpr double kDefensiveShare = 0.05;  // cosine: the density is positive wherever f may be
constexpr double kLast = 1 - 0x1p-53;

double row_edge(int row) {
  const double s = static_cast<double>(row) / kRows;
  return s * s * s * s;
}

/// Half vector of cosine 1 - d with +z.
Vec3 half_vector(double d, double phi) {
  const double sine = std::sqrt(d * (2 - d));
  return Vec3(sine * std::cos(phi), sine * std::sin(phi), 1 - d);
}

Vec3 reflect(const Vec3& w, const Vec3& h) { return 2 * glm::dot(w, h) * h - w; }

/// A choice among n of increasing `cdf` by `u`, which becomes what is left of it, again in [0, 1).
int choose(const float* cdf, int n, double& u) {
  const int i = std::min(static_cast<int>(std::upper_bound(cdf, cdf + n, u) - cdf), n - 1);
  const double below = i > 0 ? cdf[i - 1] : 0.0;
  u = std::clamp((u - below) / (cdf[i] - below), 0.0, kLast);
  return i;
}

/// Turns weights into their running sum, scaled to end at 1; equal shares when all are 0. Returns the sum.
double accumulate(const double* weight, int n, float* cdf) {
  double total = 0;
  for (int i = 0; i < n; ++i) total += weight[i];
  double running = 0;
  for (int i = 0; i < n; ++i) {
    running += total > 0 ? weight[i] / total : 1.0 / n;
    cdf[i] = static_cast<float>(running);
  }
  cdf[n - 1] = 1;
  return total;
}

/// Piecewise constant density of h, for one view.
struct HalfVectorTable {
  std::array<float, kRows> rows;
  std::array<std::array<float, kColumns>, kRows> columns;

  /// From the probability of each cell, up to a common factor.
  void build(const std::vector<double>& mass) {
    std::array<double, kRows> row_mass;
    for (size_t i = 0; i < kRows; ++i) row_mass[i] = accumulate(&mass[i * kColumns], kColumns, columns[i].data());
    accumulate(row_mass.data(), kRows, rows.data());
  }

  /// Read off the very numbers that sampling uses.
  double density(size_t row, size_t column) const {
    const double in_row = rows[row] - (row > 0 ? rows[row - 1] : 0.0f);
    const double in_column = columns[row][column] - (column > 0 ? columns[row][column - 1] : 0.0f);
    const int i = static_cast<int>(row);
    return in_row * in_column * kColumns / (2 * kPiD * (row_edge(i + 1) - row_edge(i)));
  }

  Vec3 sample(double u_row, double u_column) const {
    const int row = choose(rows.data(), kRows, u_row);
    const int column = choose(columns[static_cast<size_t>(row)].data(), kColumns, u_column);
    const double d = row_edge(row) + u_row * (row_edge(row + 1) - row_edge(row));
    return half_vector(d, 2 * kPiD * (column + u_column) / kColumns);
  }
};

/// Tables about a view, and what remains to be done to the azimuth of h.
struct ViewBlend {
  int count = 0;
  size_t table[4];
  float cdf[4];

  void add(size_t index, float weight) {
    if (weight <= 0) return;
    table[count] = index;
    cdf[count] = (count > 0 ? cdf[count - 1] : 0) + weight;
    ++count;
  }
};

struct GridPlace {
  int low;
  float share;  // of low + 1
};

GridPlace place_on(float position, int nodes) {
  const float clamped = std::clamp(position, 0.0f, static_cast<float>(nodes - 1));
  const int low = std::min(static_cast<int>(clamped), nodes - 2);
  return {low, clamped - static_cast<float>(low)};
}

float polar_angle(const Vec3& w) { return std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); }
float azimuth(const Vec3& w) { return std::atan2(w.y, w.x); }

}  // namespace

struct TableSampler::Tables {
  bool isotropic;
  std::vector<HalfVectorTable> views;

  int polar_views() const { return isotropic ? kMeridianViews : kPolarViews; }
  int azimuth_views() const { return isotropic ? 1 : kAzimuthViews; }

  /// Polar angles at the middles of equal steps: none at the horizon.
  Vec3 view(size_t i) const {
    const auto polar = static_cast<float>(i / static_cast<size_t>(azimuth_views()));
    const auto turn = static_cast<float>(i % static_cast<size_t>(azimuth_views()));
    const float theta = (polar + 0.5f) / static_cast<float>(polar_views()) * kPi / 2;
    return direction(theta, turn / static_cast<float>(azimuth_views()) * 2 * kPi);
  }

  ViewBlend blend(const Vec3& wv) const {
    const auto polar_count = static_cast<float>(polar_views());
    const GridPlace polar = place_on(polar_angle(wv) / (kPi / 2) * polar_count - 0.5f, polar_views());
    const int turns = azimuth_views();
    const float turn = isotropic ? 0 : azimuth(wv) / (2 * kPi) * static_cast<float>(turns) + static_cast<float>(turns);
    const int turn_low = static_cast<int>(turn);
    const float turn_share = turn - static_cast<float>(turn_low);
    ViewBlend set;
    for (int p = 0; p < 2; ++p) {
      for (int t = 0; t < 2; ++t) {
        const int index = (polar.low + p) * turns + (turn_low + t) % turns;
        set.add(static_cast<size_t>(index), (p ? polar.share : 1 - polar.share) * (t ? turn_share : 1 - turn_share));
      }
    }
    set.cdf[set.count - 1] = 1;
    return set;
  }

  /// Isotropic tables belong to the view at azimuth 0.
  float azimuth_of_frame(const Vec3& wv) const { return isotropic ? azimuth(wv) : 0; }
};

namespace {

/// luminance(f) cos times |dwl/dh| = 4 wv.h, averaged over each cell, times the cell's solid angle.
std::vector<double> cell_masses(const Material& material, const Vec3& wv) {
  PreparedBrdf point;
  material.prepare(wv, point);
  std::vector<double> mass(static_cast<size_t>(kRows) * kColumns, 0.0);
  constexpr int kPerRow = kSubsamples * kColumns, kPasses = kPerRow / DirectionBatch::kCapacity;
  static_assert(kPerRow % DirectionBatch::kCapacity == 0);
  for (int row = 0; row < kRows * kSubsamples; ++row) {
    const int cell_row = row / kSubsamples;
    const double low = row_edge(cell_row), height = row_edge(cell_row + 1) - low;
    const double d = low + height * (row % kSubsamples + 0.5) / kSubsamples;
    for (int pass = 0; pass < kPasses; ++pass) {
      DirectionBatch wl;
      const int first = pass * DirectionBatch::kCapacity;
      for (int k = 0; k < DirectionBatch::kCapacity; ++k) {
        wl.push(reflect(wv, half_vector(d, 2 * kPiD * (first + k + 0.5) / kPerRow)));
      }
      RgbBatch f;
      ScalarBatch pdf;
      material.eval(point, wl, f, pdf);
      for (int k = 0; k < wl.count; ++k) {
        const Vec3 h = half_vector(d, 2 * kPiD * (first + k + 0.5) / kPerRow);
        const double value = luminance(f.get(k)) * std::max(wl.z[k], 0.0f) * 4 * std::max(glm::dot(wv, h), 0.0f);
        mass[static_cast<size_t>(cell_row * kColumns + (first + k) / kSubsamples)] += std::max(value, 0.0) * height;
      }
    }
  }
  return mass;
}

}  // namespace

TableSampler::TableSampler(const Material& material) {
  auto tables = std::make_unique<Tables>();
  tables->isotropic = material.isotropic();
  tables->views.resize(static_cast<size_t>(tables->polar_views()) * static_cast<size_t>(tables->azimuth_views()));
  tbb::parallel_for(size_t{0}, tables->views.size(),
                    [&](size_t i) { tables->views[i].build(cell_masses(material, tables->view(i))); });
  tables_ = std::move(tables);
}

TableSampler::~TableSampler() = default;

Vec3 TableSampler::sample(const Vec3& wv, const Vec2& u) const {
  double rest = u.x + 0x1p-25;  // middle of the 24-bit step, as in sample_mixture
  if (rest < kDefensiveShare) {
    return sample_cosine_hemisphere({static_cast<float>(rest / kDefensiveShare), u.y});
  }
  rest = (rest - kDefensiveShare) / (1 - kDefensiveShare);
  const ViewBlend set = tables_->blend(wv);
  const int chosen = choose(set.cdf, set.count, rest);
  const Vec3 h = tables_->views[set.table[chosen]].sample(rest, u.y);
  const float turn = tables_->azimuth_of_frame(wv);
  const float c = std::cos(turn), s = std::sin(turn);
  return reflect(wv, {c * h.x - s * h.y, s * h.x + c * h.y, h.z});
}

void TableSampler::pdf(const Vec3& wv, const DirectionBatch& wl, ScalarBatch& pdf) const {
  const ViewBlend set = tables_->blend(wv);
  const float turn = tables_->azimuth_of_frame(wv);
  for (int i = 0; i < wl.count; ++i) {
    const Vec3 w = wl.get(i), sum = w + wv;
    const float length = glm::length(sum);
    pdf.v[i] = static_cast<float>(kDefensiveShare) * pdf_cosine_hemisphere(w);
    if (length <= 0) continue;
    // h and -h mirror wv to the same wl; the tables hold the one above the horizon.
    const Vec3 h = sum.z >= 0 ? sum / length : -sum / length;
    const float d = (h.x * h.x + h.y * h.y) / (1 + h.z);
    const int row = std::min(static_cast<int>(kRows * std::sqrt(std::sqrt(d))), kRows - 1);
    float place = (azimuth(h) - turn) / (2 * kPi);
    place -= std::floor(place);
    const int column = std::min(static_cast<int>(place * kColumns), kColumns - 1);
    double density = 0;
    for (int k = 0; k < set.count; ++k) {
      const double weight = set.cdf[k] - (k > 0 ? set.cdf[k - 1] : 0);
      density += weight * tables_->views[set.table[k]].density(static_cast<size_t>(row), static_cast<size_t>(column));
    }
    const float to_wl = 1 / (4 * std::max(std::abs(glm::dot(wv, h)), 1e-7f));
    pdf.v[i] += static_cast<float>((1 - kDefensiveShare) * density) * to_wl;
  }
}

uint64_t TableSampler::bytes() const { return sizeof(Tables) + tables_->views.size() * sizeof(HalfVectorTable); }

}  // namespace velour
