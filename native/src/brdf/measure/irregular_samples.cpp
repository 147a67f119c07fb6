#include "brdf/measure/irregular_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <Eigen/Dense>
#include <limits>
#include <nanoflann.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "brdf/measure/brdf_table.h"
#include "brdf/measure/microfacet_trend.h"

namespace velour {
namespace {

constexpr int kCount = IrregularInterpolant::kNeighbors;
constexpr double kHalfPower = 0.7;  // exponent of theta_h
constexpr double kAzimuthWeight = 0.3;
constexpr double kLinearBelow = 0.01;  // 1/sr: asinh turns from linear to logarithmic here
constexpr double kFalloff = 3.0;       // weight of the furthest neighbor: exp(-3)
constexpr double kRidge = 1e-3;        // on the slopes, relative to the data's own weight
constexpr size_t kMaxLeftOut = 2000;
constexpr double kWorth = 0.9;  // share of the error that must be left for a trend, or another lobe of it

using Point = std::array<double, 3>;

/// Coordinates of the regression and of the reach test.
struct Place {
  Point regression, reach;
};

Place place_of(const Vec3& wl, const Vec3& wv) {
  const HalfDiff angle = half_diff(wl, wv);
  const double theta_h = angle.theta_h, theta_d = angle.theta_d, cos_phi = std::cos(double{angle.phi_d});
  const double tilt = std::sin(theta_h) * std::sin(theta_d);
  return {{std::pow(theta_h, kHalfPower), theta_d, kAzimuthWeight * tilt * (2.0 * cos_phi * cos_phi - 1.0)},
          {theta_h, theta_d, tilt * std::abs(cos_phi)}};
}

struct Nearest {
  std::array<uint32_t, kCount> sample{};
  std::array<double, kCount> distance_sq{};  // increasing
};

double distance_sq(const Point& a, const Point& b) {
  double sum = 0.0;
  for (size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

double compress(float f) { return std::asinh(double{f} / kLinearBelow); }
float expand(double g) { return static_cast<float>(kLinearBelow * std::sinh(g)); }

}  // namespace

/// The samples as a nanoflann data set, a tree over them, and their trend.
struct IrregularInterpolant::Index {
  explicit Index(std::span<const IrregularSample> samples);

  size_t kdtree_get_point_count() const { return regression.size(); }
  double kdtree_get_pt(size_t i, size_t axis) const { return regression[i][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }

  /// Makes the regression follow a trend.
  void follow(std::span<const IrregularSample> samples, const MicrofacetTrend& wanted);
  /// What the trend leaves at a place.
  std::array<double, 3> regress(const Point& here, const Nearest& nearest) const;
  Rgb f(const Vec3& wl, const Vec3& wv, const Point& here, const Nearest& nearest) const;
  /// Sum of squared differences of compressed luminance, times the mean cosine, at samples that the regression does
  /// not see: all of them, or every nth of more than kMaxLeftOut.
  double left_out_error(std::span<const IrregularSample> samples) const;

  MicrofacetTrend trend;
  std::vector<Point> regression, reach;     // Place
  std::vector<std::array<double, 3>> rest;  // what the trend leaves of the compressed values
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Index>, Index, 3>;
  std::unique_ptr<Tree> tree;
};

IrregularInterpolant::Index::Index(std::span<const IrregularSample> samples) {
  for (const IrregularSample& sample : samples) {
    const Place place = place_of(sample.wl, sample.wv);
    regression.push_back(place.regression);
    reach.push_back(place.reach);
  }
  tree = std::make_unique<Tree>(3, *this);
  tree->buildIndex();
  // Smooth materials need no trend, and real highlights may have a shape that no trend has.
  MicrofacetTrend best;
  double least = std::numeric_limits<double>::infinity();
  for (size_t lobes = 0; lobes <= MicrofacetTrend::kMaxLobes; ++lobes) {
    const MicrofacetTrend candidate = lobes == 0 ? MicrofacetTrend() : MicrofacetTrend(samples, lobes);
    if (candidate.shapes().size() < lobes) break;
    follow(samples, candidate);
    const double error = left_out_error(samples);
    if (error < kWorth * least) least = error, best = candidate;
  }
  follow(samples, best);
}

void IrregularInterpolant::Index::follow(std::span<const IrregularSample> samples, const MicrofacetTrend& wanted) {
  trend = wanted;
  rest.clear();
  for (const IrregularSample& sample : samples) {
    const Rgb t = trend.f(sample.wl, sample.wv);
    auto& left = rest.emplace_back();
    for (int c = 0; c < 3; ++c) left[static_cast<size_t>(c)] = compress(sample.f[c]) - compress(t[c]);
  }
}

double IrregularInterpolant::Index::left_out_error(std::span<const IrregularSample> samples) const {
  double sum = 0;
  const size_t step = (samples.size() + kMaxLeftOut - 1) / kMaxLeftOut;
  for (size_t i = 0; i < samples.size(); i += step) {
    std::array<uint32_t, kCount + 1> sample{};
    std::array<double, kCount + 1> distance{};
    const size_t found = tree->knnSearch(regression[i].data(), kCount + 1, sample.data(), distance.data());
    Nearest others;
    size_t n = 0;
    for (size_t k = 0; k < found && n < kCount; ++k) {
      if (sample[k] == i) continue;
      others.sample[n] = sample[k];
      others.distance_sq[n++] = distance[k];
    }
    if (n < kCount) return 0;  // too few to tell
    const double cosine = 0.5 * (samples[i].wl.z + samples[i].wv.z);
    const float found_f = luminance(f(samples[i].wl, samples[i].wv, regression[i], others));
    const double difference = compress(luminance(samples[i].f)) - compress(found_f);
    sum += cosine * difference * difference;
  }
  return sum;
}

Rgb IrregularInterpolant::Index::f(const Vec3& wl, const Vec3& wv, const Point& here, const Nearest& nearest) const {
  const auto left = regress(here, nearest);
  Rgb value = trend.f(wl, wv);
  for (int c = 0; c < 3; ++c) value[c] = expand(compress(value[c]) + left[static_cast<size_t>(c)]);
  return value;
}

IrregularInterpolant::IrregularInterpolant(std::span<const IrregularSample> samples) {
  if (samples.size() < kNeighbors)
    throw Error(Status::invalid_argument, std::to_string(samples.size()) +
                                              " valid samples are too few to interpolate; at least " +
                                              std::to_string(kNeighbors) + " are needed.");
  index_ = std::make_unique<const Index>(samples);
}

IrregularInterpolant::~IrregularInterpolant() = default;

std::optional<Rgb> IrregularInterpolant::f(const Vec3& wl, const Vec3& wv) const {
  const Place here = place_of(wl, wv);
  Nearest nearest;
  (void)index_->tree->knnSearch(here.regression.data(), kCount, nearest.sample.data(), nearest.distance_sq.data());
  const double reach = index_->trend.shapes().empty() ? kReach : kReachOfTrend;
  const bool in_reach = std::any_of(nearest.sample.begin(), nearest.sample.end(), [&](uint32_t n) {
    return distance_sq(here.reach, index_->reach[n]) <= reach * reach;
  });
  if (!in_reach) return std::nullopt;
  return index_->f(wl, wv, here.regression, nearest);
}

std::array<double, 3> IrregularInterpolant::Index::regress(const Point& here, const Nearest& nearest) const {
  const double width = std::max(nearest.distance_sq.back(), 1e-12);
  Eigen::Matrix<double, kCount, 4> terms;
  Eigen::Matrix<double, kCount, 3> data;
  Eigen::Matrix<double, kCount, 1> weights;
  for (int i = 0; i < kCount; ++i) {
    const auto n = static_cast<size_t>(i);
    const Point& there = regression[nearest.sample[n]];
    const auto& left = rest[nearest.sample[n]];
    terms.row(i) << 1.0, there[0] - here[0], there[1] - here[1], there[2] - here[2];
    data.row(i) << left[0], left[1], left[2];
    weights(i) = std::exp(-kFalloff * nearest.distance_sq[n] / width);
  }
  Eigen::Matrix4d normal = terms.transpose() * weights.asDiagonal() * terms;
  normal.diagonal().tail<3>().array() += kRidge * weights.sum() * width;
  const Eigen::Matrix<double, 4, 3> moment = terms.transpose() * weights.asDiagonal() * data;
  const Eigen::Matrix<double, 4, 3> solution = normal.ldlt().solve(moment);
  std::array<double, 3> found{};
  for (int c = 0; c < 3; ++c) {
    const double low = data.col(c).minCoeff(), high = data.col(c).maxCoeff(), range = high - low;
    found[static_cast<size_t>(c)] = std::clamp(solution(0, c), low, trend.shapes().empty() ? high + range : high);
  }
  return found;
}

namespace {

constexpr float kSpike = 8.0f;     // times as bright as its neighbors
constexpr size_t kMaxBright = 2;   // neighbors that may be as bright: other spikes
constexpr int kSurrounding = 3;    // dimmer neighbors on a side
constexpr float kDimShare = 0.1f;  // of the median: what is dimmer is no measure of a spike
constexpr double kMaxSpikes = 1 / 30.0;

/// Places of samples as a nanoflann data set.
struct PlaceCloud {
  std::vector<Place> places;
  size_t kdtree_get_point_count() const { return places.size(); }
  double kdtree_get_pt(size_t i, size_t axis) const { return places[i].regression[axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace

std::vector<IrregularSample> without_spikes(std::vector<IrregularSample> samples) {
  if (samples.size() < 2 * kCount) return samples;
  PlaceCloud cloud;
  std::vector<float> bright;
  for (const IrregularSample& sample : samples) {
    cloud.places.push_back(place_of(sample.wl, sample.wv));
    bright.push_back(luminance(sample.f));
  }
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PlaceCloud>, PlaceCloud, 3> tree(3, cloud);
  tree.buildIndex();
  std::vector<float> sorted = bright;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2));
  const float dimmest = kDimShare * std::max(sorted[sorted.size() / 2], 0.0f);
  const auto is_spike = [&](size_t i) {
    std::array<uint32_t, kCount + 1> near{};
    std::array<double, kCount + 1> distance{};
    const size_t found = tree.knnSearch(cloud.places[i].regression.data(), kCount + 1, near.data(), distance.data());
    size_t as_bright = 0;
    int inside = 0, below = 0, above = 0;
    for (size_t k = 0; k < found; ++k) {
      if (near[k] == i) continue;
      if (!(bright[i] > kSpike * std::max(bright[near[k]], dimmest))) {
        if (++as_bright > kMaxBright) return false;
        continue;
      }
      const Point &here = cloud.places[i].reach, &there = cloud.places[near[k]].reach;
      inside += there[0] < here[0];
      below += there[1] < here[1];
      above += there[1] > here[1];
    }
    return std::min({inside, below, above}) >= kSurrounding;
  };
  std::vector<IrregularSample> kept;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!is_spike(i)) kept.push_back(samples[i]);
  }
  const auto spikes = static_cast<double>(samples.size() - kept.size());
  return spikes > kMaxSpikes * static_cast<double>(samples.size()) ? std::move(samples) : std::move(kept);
}

std::vector<TableNode> resample_irregular(const IrregularInterpolant& interpolant, const BrdfTableLayout& layout,
                                          const Progress& progress) {
  const HorizonTest horizon(layout);
  std::vector<TableNode> nodes(layout.size());
  parallel_fill(static_cast<size_t>(layout.theta_h), [&](size_t row) {
    progress.check();
    const int i = static_cast<int>(row);
    for (int k = 0; k < layout.theta_d; ++k)
      for (int l = 0; l <= layout.phi_d / 2; ++l) {
        if (!horizon.above(i, k, l)) continue;
        const DirectionPair pair = layout.pair(i, 0, k, l);
        const auto f = interpolant.f(pair.wl, pair.wv);
        if (!f) continue;
        // f is the same at phi_d and pi - phi_d: mirror in the plane of incidence, then exchange the directions.
        const int mirror = (layout.phi_d - l) % layout.phi_d;
        nodes[layout.index(i, 0, k, l)] = nodes[layout.index(i, 0, k, mirror)] = {{f->r, f->g, f->b, 1.0f}};
      }
  });
  return nodes;
}

namespace {

constexpr double kRing = 10.0 * kPiD / 180.0;        // theta_d: half the width of a ring, and the step between rings
constexpr double kNearMirror = 15.0 * kPiD / 180.0;  // theta_h of highlights
constexpr double kSameHalf = 0.5 * kPiD / 180.0;     // samples closer in theta_h say nothing about a width
constexpr double kStandsOut = 20.0;                  // the brightest sample over the median
constexpr double kFalls = 0.1;                       // of the brightest: still part of the highlight
constexpr size_t kFewestInRing = 8;

struct RingSample {
  double theta_h, value;
};

/// Angle from the brightest sample of a ring to the next, if none but the brightest shows its highlight. Nothing if
/// there is no highlight.
std::optional<double> gap_in_ring(std::vector<RingSample> ring) {
  if (ring.size() < kFewestInRing) return std::nullopt;
  const auto dimmer = [](const RingSample& a, const RingSample& b) { return a.value < b.value; };
  std::ranges::sort(ring, dimmer);
  const RingSample& top = ring.back();
  const double median = ring[ring.size() / 2].value;
  if (!(top.value > kStandsOut * std::max(median, 0.0)) || !(top.value > 0.0) || top.theta_h > kNearMirror)
    return std::nullopt;
  double gap = kPiD;
  for (const RingSample& s : ring) {
    const double apart = std::abs(s.theta_h - top.theta_h);
    if (apart < kSameHalf) continue;
    if (s.value >= kFalls * top.value) return 0.0;
    gap = std::min(gap, apart);
  }
  return gap;
}

}  // namespace

double gap_of_unresolved_highlights(std::span<const IrregularSample> samples) {
  constexpr size_t kRings = 9;
  std::array<std::vector<RingSample>, kRings> rings;
  for (const IrregularSample& s : samples) {
    const HalfDiff angle = half_diff(s.wl, s.wv);
    const double theta_d = angle.theta_d;
    for (size_t r = 0; r < kRings; ++r) {
      if (std::abs(theta_d - static_cast<double>(r) * kRing) > kRing) continue;
      rings[r].push_back({angle.theta_h, static_cast<double>(luminance(s.f))});
    }
  }
  size_t open = 0, resolved = 0;
  double sum = 0.0;
  for (const auto& ring : rings) {
    const auto gap = gap_in_ring(ring);
    if (!gap) continue;
    ++(*gap > 0.0 ? open : resolved);
    sum += *gap;
  }
  return open > resolved ? sum / static_cast<double>(open) : 0.0;
}

}  // namespace velour
