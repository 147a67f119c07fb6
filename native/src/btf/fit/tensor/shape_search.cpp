#include "btf/fit/tensor/shape_search.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Core>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include "base/error.h"
#include "math/tensor/cluster_choice.h"
#include "math/tensor/cluster_fit.h"

namespace velour {

namespace {

constexpr Index kFittedSlices = 1000, kJudgedSlices = 500;
constexpr int kShapeIterations = 3;  // iterations of the fit by which a shape is judged
constexpr double kShapeTolerance = 2e-3;
constexpr size_t kMaxShapeTrials = 36;
constexpr double kShareStep = 0.12, kMinShare = 0.12, kMaxShare = 0.96;
// Remaining fraction of ReliefGap::share(): texels are solved for on the images, which repairs the rest. By experiment:
// weave 0.26, corduroy 0.25, gravel 0.30.
constexpr double kLeftOfRelief = 0.27;
constexpr uint32_t kStarts[] = {1, 2, 8};  // numbers of clusters
constexpr uint32_t kUsualMembers = 2;
constexpr double kUsualShare = 0.6;  // the texels' share of the bytes
constexpr double kWorthClusters = 0.99;
constexpr double kMaxOff = 0.08, kOff = 2;  // relative error of estimates; kOff over the coefficients per texel

class ShapeSearch {
 public:
  ShapeSearch(const TensorView& slices, const ShapeSearchOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        fitted_(slices.range(0, 0, few(slices) ? slices.extent(0) : kFittedSlices)),
        judged_(few(slices) ? fitted_ : slices.range(0, kFittedSlices, kJudgedSlices)) {}

  FoundShape run() {
    found_.relief_error = kLeftOfRelief * options_.relief_share;
    std::vector<JudgedShape> ends;
    for (const uint32_t clusters : kStarts) {
      const double share = ends.empty() ? kUsualShare : ends[0].choice.texel_share;
      const auto start =
          start_of(std::clamp(clusters, options_.range.least_clusters, options_.range.most_clusters), share);
      if (start && started_.insert(start->clusters).second) ends.push_back(judged(walk(*start)));
    }
    if (ends.empty()) refuse();
    found_.best = ends[0];
    for (const JudgedShape& end : ends) {
      if (is_better_shape(end.choice.clusters, end.error, found_.best.choice.clusters, found_.best.error))
        found_.best = end;
    }
    for (const JudgedShape& end : ends) {
      if (!found_.rival && is_rival(end, found_.best)) found_.rival = end;
    }
    found_.view_rank = options_.extent.view_rank;
    found_.light_rank = options_.extent.light_rank;
    progress_.update(1.0);
    return std::move(found_);
  }

 private:
  static bool few(const TensorView& slices) { return slices.extent(0) < kFittedSlices + kJudgedSlices; }

  JudgedShape judged(const ShapeChoice& choice) {
    return {choice, *largest_shape(choice, options_.extent, options_.bytes), error(choice)};
  }

  /// Walks to the best choice found within a number of trials.
  ShapeChoice walk(ShapeChoice best) {
    const size_t most = found_.trials.size() + kMaxShapeTrials / std::size(kStarts);
    double least = error(best);
    for (bool better = true; better;) {
      better = false;
      for (const ShapeChoice& next : neighbors(best)) {
        if (best.clusters == 1 && next.clusters > 1) continue;  // larger numbers have their own walks
        if (found_.trials.size() >= most) return best;
        if (!(error(next) < least)) continue;
        best = next;
        least = error(next);
        better = true;
      }
    }
    return best;
  }

  [[noreturn]] void refuse() const {
    throw Error(Status::invalid_argument,
                "No model of this method fits into " + std::to_string(options_.bytes) +
                    " bytes. Raise the maximum size, or reduce the number of clusters and members.");
  }

  /// A choice of `clusters` clusters, or fewer if those exceed the bytes, with `share` or else another share.
  std::optional<ShapeChoice> start_of(uint32_t clusters, double share) const {
    const ShapeRange& range = options_.range;
    for (;; clusters = std::max(clusters / 2, range.least_clusters)) {
      const uint32_t most = std::min({kUsualMembers, range.most_members, clusters});
      for (uint32_t members = std::max(most, range.least_members); members >= range.least_members; --members) {
        for (const double s : {share, kUsualShare, 0.36, 0.84, 0.96}) {
          for (const uint32_t colors : {2u, 1u}) {
            const ShapeChoice choice{clusters, members, colors, s};
            if (members <= clusters && largest_shape(choice, options_.extent, options_.bytes)) return choice;
          }
        }
      }
      if (clusters <= range.least_clusters) return std::nullopt;
    }
  }

  std::vector<ShapeChoice> neighbors(const ShapeChoice& of) const {
    std::vector<ShapeChoice> next;
    const auto add = [&](uint32_t clusters, uint32_t members, uint32_t colors, double share) {
      const ShapeRange& range = options_.range;
      if (clusters < range.least_clusters || clusters > range.most_clusters) return;
      members = std::min(members, clusters);
      if (members < range.least_members || members > range.most_members) return;
      if (colors < 1 || colors > 3 || share < kMinShare || share > kMaxShare) return;
      next.push_back({clusters, members, colors, share});
    };
    for (const double step : {kShareStep, -kShareStep}) {
      add(of.clusters, of.members, of.colors, next_share(of, step));
    }
    add(2 * of.clusters, of.members, of.colors, of.texel_share);
    add(of.clusters / 2, of.members, of.colors, of.texel_share);
    add(of.clusters, of.members + 1, of.colors, of.texel_share);
    add(of.clusters, of.members - 1, of.colors, of.texel_share);
    add(of.clusters, of.members, of.colors + 1, of.texel_share);
    add(of.clusters, of.members, of.colors - 1, of.texel_share);
    return next;
  }

  /// The next share in steps of `step` that gives another texel rank; out of bounds if there is none.
  double next_share(ShapeChoice of, double step) const {
    const auto rank = [&] {
      const auto shape = largest_shape(of, options_.extent, options_.bytes);
      return shape ? shape->rank.texel : 0;
    };
    const uint32_t now = rank();
    do of.texel_share += step;
    while (of.texel_share >= kMinShare && of.texel_share <= kMaxShare && rank() == now);
    return of.texel_share;
  }

  /// Error of a choice, which is tried once; larger than any other if it exceeds the bytes.
  double error(const ShapeChoice& choice) {
    const auto key = std::tuple(choice.clusters, choice.members, choice.colors, std::lround(100 * choice.texel_share));
    const auto known = errors_.find(key);
    if (known != errors_.end()) return known->second;
    const auto shape = largest_shape(choice, options_.extent, options_.bytes);
    return errors_[key] = shape ? tried(*shape) : 2.0;
  }

  double tried(const TensorShape& shape) {
    const double error = error_of(shape);
    found_.trials.push_back({shape.clusters,
                             shape.members,
                             {shape.rank.texel, shape.rank.view, shape.rank.light, shape.rank.color},
                             tensor_bytes(shape, options_.extent),
                             error});
    return error;
  }

  double error_of(const TensorShape& shape) {
    const TensorOptions tensor{options_.seed, options_.threads};
    const RowMatrix& coordinates = coordinates_for(shape, tensor);
    const ClusterOptions fit{.clusters = shape.clusters,
                             .members = shape.members,
                             .ranks = {shape.rank.texel, shape.rank.view, shape.rank.light, shape.rank.color},
                             .iterations = kShapeIterations,
                             .tolerance = kShapeTolerance,
                             .coordinates = &coordinates,
                             .tensor = tensor};
    const double done = static_cast<double>(found_.trials.size()) / kMaxShapeTrials;
    const Progress::Span trial(progress_, done, std::min(1.0, done + 1.0 / kMaxShapeTrials));
    progress_.stage("searching the model shape", 0, 1);
    ClusteredTensor found = fit_clusters(fitted_, fit, progress_).tensor;
    const double of_slices = relative_error(found, tensor);
    return std::sqrt(of_slices * of_slices + found_.relief_error);
  }

  /// Coordinates of the fitted slices, from which clusters are initialized.
  const RowMatrix& coordinates_for(const TensorShape& shape, const TensorOptions& options) {
    const Index entries = fitted_.size() / fitted_.extent(0);
    const Index rank = std::min<Index>({2 * Index{shape.rank.texel}, fitted_.extent(0), entries});
    if (coordinates_.cols() < rank) {
      coordinates_ = slice_coordinates({fitted_.data(), {fitted_.extent(0), entries}}, rank, options, progress_);
    }
    return coordinates_;
  }

  /// Relative error on the judged slices.
  double relative_error(ClusteredTensor& tensor, const TensorOptions& options) const {
    std::vector<RowMatrix> basis;
    for (const TensorCluster& cluster : tensor.cluster) basis.push_back(cluster.basis(options, progress_));
    const Index slices = judged_.extent(0), entries = judged_.size() / slices;
    tensor.coefficient.resize(0, 0);
    const ClusterProducts products(TensorView(judged_.data(), {slices, entries}), basis, options, progress_);
    const double kept = choose_members(products, tensor, options, progress_).after;
    const double all = Eigen::Map<const Eigen::VectorXf>(judged_.data(), judged_.size()).cast<double>().squaredNorm();
    return all > 0 ? std::sqrt(std::max(0.0, all - kept) / all) : 0.0;
  }

  const ShapeSearchOptions& options_;
  Progress& progress_;
  TensorView fitted_, judged_;
  FoundShape found_;
  RowMatrix coordinates_;
  std::set<uint32_t> started_;  // numbers of clusters from which a walk started
  std::map<std::tuple<uint32_t, uint32_t, uint32_t, long>, double> errors_;
};

}  // namespace

bool is_better_shape(uint32_t clusters, double error, uint32_t others, double least) {
  return error < (clusters > others ? kWorthClusters : 1.0) * least;
}

bool is_rival(const JudgedShape& other, const JudgedShape& best) {
  const double off = std::min(kMaxOff, kOff / best.shape.coefficients());
  return other.choice.clusters != best.choice.clusters && other.error < (1 + off) * best.error;
}

FoundShape search_shape(const TensorView& slices, const ShapeSearchOptions& options, Progress& progress) {
  return ShapeSearch(slices, options, progress).run();
}

namespace {

constexpr double kViewsOfLights = 0.85;  // ratio of view to light ranks: shadows have sharper edges than masking

uint64_t texel_bytes(const TensorShape& shape, const TensorExtent& extent) {
  return uint64_t{shape.members} * (1 + shape.rank.texel) + (extent.relief ? sizeof(HalfBits) : 0);
}

/// Bytes of all clusters.
uint64_t cluster_bytes(const TensorShape& shape, const TensorExtent& extent) {
  const TensorSide::Ranks& r = shape.rank;
  const uint64_t core = uint64_t{r.texel} * r.view * r.light * r.color;
  const uint64_t factors = extent.views * r.view + extent.lights * r.light + 3 * uint64_t{r.color};
  return shape.clusters * ((core + factors) * sizeof(HalfBits) + r.texel * sizeof(ByteScale));
}

/// Largest texel and light rank that evaluators and model files hold for each of so many clusters.
uint32_t max_rank(uint32_t clusters) {
  return static_cast<uint32_t>(TensorBtf::kMaxClusterRanks / clusters / kRankPadding * kRankPadding);
}

/// Sets the light rank to `lights`, and the view and texel ranks to match.
TensorShape with_lights(TensorShape shape, uint32_t lights, const TensorExtent& extent) {
  const auto views = static_cast<uint32_t>(std::lround(kViewsOfLights * lights));
  shape.rank.light = std::min({lights, extent.light_rank, max_rank(shape.clusters)});
  shape.rank.view = std::clamp<uint32_t>(views, 1, extent.view_rank);
  shape.rank.texel = std::min(shape.rank.texel, shape.rank.view * shape.rank.light * shape.rank.color);
  return shape;
}

}  // namespace

uint64_t tensor_bytes(const TensorShape& shape, const TensorExtent& extent) {
  return extent.texels * texel_bytes(shape, extent) + cluster_bytes(shape, extent);
}

std::optional<TensorShape> largest_shape(const ShapeChoice& choice, const TensorExtent& extent, uint64_t bytes) {
  TensorShape shape{choice.clusters, choice.members, {1, 1, 1, choice.colors}};
  const double a_texel = choice.texel_share * static_cast<double>(bytes) / static_cast<double>(extent.texels);
  const double rank = std::floor((a_texel - (extent.relief ? 2.0 : 0.0)) / choice.members) - 1;
  const auto most = static_cast<double>(
      std::min<uint64_t>({TensorBtf::kMaxRank, max_rank(choice.clusters), extent.functions / choice.clusters,
                          (extent.finest + choice.clusters - 1) / choice.clusters}));
  if (rank < 1 || most < 1) return std::nullopt;
  shape.rank.texel = static_cast<uint32_t>(std::min(rank, most));
  std::optional<TensorShape> found;
  for (uint32_t lights = 1; lights <= std::max(extent.light_rank, 2 * extent.view_rank); ++lights) {
    const TensorShape larger = with_lights(shape, lights, extent);
    if (tensor_bytes(larger, extent) > bytes) break;
    found = larger;
  }
  return found;
}

}  // namespace velour
