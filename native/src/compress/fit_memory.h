// What fits hold in memory at once, and what a limit allows.
#pragma once

#include <cstdint>
#include <string>

#include "btf/btf_measurement.h"

namespace velour {

/// Sizes that a fit's memory follows from.
struct FitExtent {
  uint64_t texels = 0, pyramid_texels = 0, pairs = 0;
  uint64_t lights = 0;  // of a view
  uint64_t sides = 1;
  uint64_t points = 0, point_pairs = 0;  // that lobes are refined by: of a side, of a point
  uint64_t coefficients = 0;             // of a texel, or components
  uint64_t threads = 1;
  bool by_view = false;  // components: of a view each
};

/// What a fit is about to take, by its sizes alone.
struct FitSize {
  uint64_t memory = 0;        // bytes that it holds at once where nothing limits it
  uint64_t least_memory = 0;  // the least limit that it can be kept to
  uint64_t bytes = 0;         // of all coefficients, at most
};

/// The number of points that the order of SRBFs is chosen by, between the least and the usual one, which keeps the fit
/// within `memory` bytes. Throws Error(unsupported) with the least that would do.
uint32_t search_points_within(uint64_t memory, const FitExtent& extent);
/// The least limit that leaves it all of the points, and so the model that it makes without one.
uint64_t memory_for_all_points(const FitExtent& extent);
/// The least limit that it can be kept to.
uint64_t memory_for_least_points(const FitExtent& extent);

/// Whole ones, rounded up: "17 MB".
std::string megabytes(uint64_t bytes);

/// Of a truncated SVD of so many components.
uint64_t memory_for_components(const FitExtent& extent);
/// Throws Error(unsupported), with what would do, where a truncated SVD of so many components holds more than `memory`.
void require_components(uint64_t memory, const FitExtent& extent);

/// The most components, `coefficients` at most, that a truncated SVD can look at within `memory` bytes. Throws
/// Error(unsupported) with the least that would do.
uint64_t components_within(uint64_t memory, FitExtent extent);

/// What a fit of clustered tensors may hold.
struct TensorAllowance {
  size_t point_floats = 16 << 20;  // that bases of the directions are found by
  size_t slices = 6144;            // texels that clusters are sought for
  uint32_t functions = 640;        // of all clusters: whose products of each view the texels are solved for by
};

/// Bytes of a fit that may hold so much; `entries`: of a slice.
uint64_t memory_for_tensors(const FitExtent& extent, uint64_t entries, const TensorAllowance& allowance);
/// What any fit needs.
TensorAllowance least_tensor_allowance();
/// The most that keeps the fit within `memory` bytes (0: no limit). Throws Error(unsupported)
/// with the least that would do.
TensorAllowance tensor_allowance(uint64_t memory, const FitExtent& extent, uint64_t entries);

}  // namespace velour
