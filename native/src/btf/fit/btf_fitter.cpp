#include "btf/fit/btf_fitter.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "btf/fit/srbf/lobe_order.h"
#include "btf/fit/tensor/function_refit.h"

namespace velour {

void BtfFitter::bound(uint64_t bytes, const std::string& one) {
  const std::vector<OrderPoint>& points = curve_.points;
  const auto past = std::upper_bound(points.begin(), points.end(), bytes,
                                     [](uint64_t n, const OrderPoint& p) { return n < p.parameter_bytes; });
  if (past == points.begin()) {
    throw Error(Status::invalid_argument, one + " takes " + std::to_string(points.front().parameter_bytes) +
                                              " bytes, but the maximum size is " + std::to_string(bytes) +
                                              " bytes. Raise the maximum size.");
  }
  largest_ = static_cast<size_t>(past - points.begin()) - 1;
}

namespace {

constexpr uint64_t kFloat = sizeof(float), kHalf = sizeof(HalfBits);
constexpr uint32_t kUsualPoints = 64, kMinPoints = 8;
constexpr uint64_t kSliceCopies = 4;
constexpr uint32_t kMinFunctions = 40, kMinSlices = 384;
constexpr uint64_t kLibraries = 8 << 20;  // thread stacks and pools, and small allocations

/// A view: halves, values, planes along the axes, all their levels by texel, and the values of the next level.
uint64_t reading_bytes(const FitExtent& e) {
  return e.texels * e.lights * 3 * (2 * kHalf + kFloat + kFloat + 2 * kFloat + kFloat);
}

/// Points with their pairs, whose lists grow by doubling.
uint64_t point_bytes(const FitExtent& e) {
  return e.sides * e.points * e.point_pairs * 2 * (sizeof(LobeArguments) + 3 * kFloat);
}

/// One point: all candidates at its pairs, and bases of three axes with room for as much again.
uint64_t search_point_bytes(const FitExtent& e) {
  const uint64_t pairs = std::min(e.point_pairs, kOrderPairs);
  return pairs * kFloat * (kLobeCandidates + 4 * e.coefficients) + 6 * kLobeCandidates * kFloat;
}

/// Lobe arguments in both frames, and each thread's matrices of values.
uint64_t refinement_bytes(const FitExtent& e) {
  return e.points * e.point_pairs * 2 * 9 * kFloat + e.threads * e.point_pairs * e.coefficients * 4 * kFloat +
         e.points * e.coefficients * 9 * kFloat;
}

/// Moments of all levels, and the vectors of the conjugate gradients on the finest one.
uint64_t texel_bytes(const FitExtent& e) {
  return (e.pyramid_texels + 10 * e.texels) * e.coefficients * kFloat + e.texels * 128;
}

/// The model, its evaluator, and the images of each thread.
uint64_t judging_bytes(const FitExtent& e) {
  return 3 * e.pyramid_texels * e.coefficients * kFloat + e.threads * e.texels * 3 * (kHalf + 2 * kFloat);
}

[[noreturn]] void refuse(uint64_t memory, uint64_t least, const std::string& of_what) {
  throw Error(Status::unsupported, "The fit requires at least " + megabytes(least) + " of memory, for " + of_what +
                                       "; the limit is " + megabytes(memory) +
                                       ". Raise the memory limit, or capture fewer texels or lights.");
}

uint64_t svd_bytes(const FitExtent& e) {
  const uint64_t columns = e.coefficients + 8;
  const uint64_t sketches = 3 * columns * (2 * e.texels + e.pairs) * kFloat;
  const uint64_t turning = columns * std::max(4 * e.texels * kFloat, 3 * e.pairs * sizeof(double));
  const uint64_t projecting = e.coefficients * (2 * e.pairs + 2 * e.pyramid_texels) * kFloat;
  return kLibraries + reading_bytes(e) + sketches + std::max(turning, projecting) + judging_bytes(e);
}

/// Functions of all views, products of one view's images, and the projection.
uint64_t view_svd_bytes(const FitExtent& e) {
  const uint64_t columns = std::min<uint64_t>(e.lights, FactoredBtf::kMaxOfView / 3);
  const uint64_t functions = 3 * e.pairs * columns * kFloat + 5 * e.lights * e.lights * sizeof(double);
  const uint64_t projecting = e.coefficients * (2 * e.lights + 2 * e.pyramid_texels) * kFloat;
  return kLibraries + reading_bytes(e) + functions + projecting + judging_bytes(e);
}

uint64_t slice_bytes(const FitExtent& e, const TensorAllowance& allowance, uint64_t entries) {
  return std::min<uint64_t>(allowance.slices, e.texels) * entries * kFloat;
}

/// Slices with copies and projections of a cluster's slices, or slices with a view and the points of the bases.
uint64_t clustering_bytes(const FitExtent& e, const TensorAllowance& allowance, uint64_t entries) {
  const uint64_t slices = slice_bytes(e, allowance, entries);
  return std::max(kSliceCopies * slices, slices + reading_bytes(e) + 2 * allowance.point_floats * kFloat);
}

void halve_slices(TensorAllowance& allowance) {
  allowance.slices /= 2;
  allowance.point_floats /= 2;
}

/// Visibility of texels: positions and stand-ins in all views, and the values of one view.
uint64_t shown_bytes(const FitExtent& e) {
  return e.pairs / e.lights * e.pyramid_texels * (sizeof(Vec2) + sizeof(int32_t)) + 3 * e.texels * e.lights * kFloat;
}

/// Moments of all levels and of a view, functions of all views and their products.
uint64_t tensor_texel_bytes(const FitExtent& e, uint64_t functions) {
  return (3 * e.pyramid_texels + 2 * e.texels) * functions * kFloat + shown_bytes(e) +
         e.pairs / e.lights * (functions + 3 * e.lights) * functions * kFloat;
}

/// Moments of all views, the texels seen in a view, and linear systems over the factors' ranks.
uint64_t tensor_refit_bytes(const FitExtent& e, uint64_t functions) {
  const uint64_t views = e.pairs / e.lights;
  const uint64_t moments = views * (functions + 3 * e.lights) * functions * kFloat;
  const uint64_t seen = (2 * e.pyramid_texels + e.texels) * functions * kFloat + shown_bytes(e);
  return moments + seen + 2 * kMomentGroups * uint64_t{kMaxJointRanks} * kMaxJointRanks * sizeof(double);
}

/// Memory of a fit of SRBFs whose order is chosen from `points` points.
uint64_t search_bytes(const FitExtent& e, uint64_t points) {
  return kLibraries + point_bytes(e) +
         std::max({reading_bytes(e) + texel_bytes(e), refinement_bytes(e), judging_bytes(e),
                   points * search_point_bytes(e)});
}

}  // namespace

std::string megabytes(uint64_t bytes) { return std::to_string((bytes + 999999) / 1000000) + " MB"; }

uint64_t memory_for_tensors(const FitExtent& extent, uint64_t entries, const TensorAllowance& allowance) {
  const uint64_t texels =
      std::max(tensor_texel_bytes(extent, allowance.functions), tensor_refit_bytes(extent, allowance.functions));
  // Slices are kept because another shape or size may be fitted.
  return kLibraries + std::max(clustering_bytes(extent, allowance, entries),
                               slice_bytes(extent, allowance, entries) + reading_bytes(extent) + texels);
}

TensorAllowance least_tensor_allowance() {
  TensorAllowance allowance;
  while (allowance.functions > kMinFunctions) allowance.functions /= 2;
  while (allowance.slices > kMinSlices) halve_slices(allowance);
  return allowance;
}

TensorAllowance tensor_allowance(uint64_t memory, const FitExtent& extent, uint64_t entries) {
  TensorAllowance allowance;
  if (memory == 0) return allowance;
  const auto held = [&] { return memory_for_tensors(extent, entries, allowance); };
  while (held() > memory && allowance.functions > kMinFunctions) allowance.functions /= 2;
  while (held() > memory && allowance.slices > kMinSlices) halve_slices(allowance);
  if (held() > memory)
    refuse(
        memory, held(),
        "one view of " + std::to_string(extent.texels) + " texels under " + std::to_string(extent.lights) + " lights");
  allowance.inverse_bytes = memory - held();
  return allowance;
}

uint32_t search_points_within(uint64_t memory, const FitExtent& extent) {
  const uint64_t least = memory_for_least_points(extent);
  if (least > memory) {
    refuse(memory, least,
           "one view of " + std::to_string(extent.texels) + " texels under " + std::to_string(extent.lights) +
               " lights and " + std::to_string(extent.coefficients) + " coefficients per texel");
  }
  const uint64_t held = kLibraries + point_bytes(extent);
  return static_cast<uint32_t>(std::min<uint64_t>(kUsualPoints, (memory - held) / search_point_bytes(extent)));
}

uint64_t memory_for_all_points(const FitExtent& extent) { return search_bytes(extent, kUsualPoints); }

uint64_t memory_for_least_points(const FitExtent& extent) { return search_bytes(extent, kMinPoints); }

uint64_t memory_for_components(const FitExtent& extent) {
  return extent.by_view ? view_svd_bytes(extent) : svd_bytes(extent);
}

void require_components(uint64_t memory, const FitExtent& extent) {
  const uint64_t bytes = memory_for_components(extent);
  if (bytes > memory) refuse(memory, bytes, std::to_string(extent.coefficients) + " components");
}

uint64_t components_within(uint64_t memory, uint64_t least, FitExtent extent) {
  while (extent.coefficients > least && memory_for_components(extent) > memory) --extent.coefficients;
  if (memory_for_components(extent) <= memory) return extent.coefficients;
  refuse(memory, memory_for_components(extent),
         (least == 1 ? "one component" : std::to_string(least) + " components") + " of " +
             std::to_string(extent.texels) + " texels and " + std::to_string(extent.pairs) + " pairs");
}

}  // namespace velour
