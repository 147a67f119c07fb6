// Base of BTF fits that can be made at many sizes, and the memory that they use.
#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include "base/progress.h"
#include "base/warning.h"
#include "btf/measure/btf_measurement.h"
#include "btf/model/factored_btf.h"
#include "model/model.h"

namespace velour {

// Options of all BTF fits.

struct BtfFitOptions {
  /// Maximum size of the model. 0: the method's default fraction of the measurement (singular values 1:200, others
  /// 1:400), but at least its minimum; with a tolerance, as much as it takes.
  uint64_t bytes = 0;
  double tolerance = 0;  // maximum relative L2 error of companded values (BtfErrors); 0: none, use all bytes
  Companding companding = Companding::root;
  uint64_t seed = 0;
  int threads = 0;      // 0: all
  uint64_t memory = 0;  // maximum bytes that the fit holds at once; 0: no limit
  bool relief = true;   // texels lie on the structure's surface, if the BTF has one, or else on the reference plane;
                        // ignored by singular values
  // Clustered tensors only:
  uint32_t clusters = 0;  // per side; 0: automatic (shape_search.h)
  uint32_t members = 0;   // clusters per texel; 0: automatic
};

/// The constructor computes what all sizes share: the colors, and the order in which functions are worth their bytes.
/// fit() makes a model of one size.
class BtfFitter {
 public:
  virtual ~BtfFitter() = default;

  /// One point per size, ascending. `relative_l2`: expected error of the companded values before the fit;
  /// `parameter_bytes`: upper bound.
  const OrderCurve& curve() const { return curve_; }
  /// Index of the largest point within the requested bytes.
  size_t largest() const { return largest_; }
  /// Fits the model of a point. Deterministic; the same bits for any number of threads.
  virtual ModelBody fit(size_t point) = 0;
  /// Shapes of clustered tensors that were tried.
  const std::vector<ShapeTrial>& shapes() const { return shapes_; }
  /// Number of entries of the measurement that are not finite.
  uint64_t not_finite() const { return not_finite_; }
  /// Warnings about the models.
  const std::vector<Warning>& warnings() const { return warnings_; }

 protected:
  /// Sets largest(). Throws Error(invalid_argument) if even the first point, described by `one`, exceeds `bytes`.
  void bound(uint64_t bytes, const std::string& one);

  OrderCurve curve_;
  size_t largest_ = 0;
  std::vector<ShapeTrial> shapes_;
  uint64_t not_finite_ = 0;
  std::vector<Warning> warnings_;
};

// Memory use of fits, and what fits into a memory limit.

/// Sizes that determine the memory of a fit.
struct FitExtent {
  uint64_t texels = 0, pyramid_texels = 0, pairs = 0;
  uint64_t lights = 0;  // per view
  uint64_t sides = 1;
  uint64_t points = 0, point_pairs = 0;  // for refining lobes: points per side, pairs per point
  uint64_t coefficients = 0;             // per texel, or number of components
  uint64_t threads = 1;
  bool by_view = false;  // each component serves one view
};

/// Estimated requirements of a fit, from its sizes alone.
struct FitSize {
  uint64_t memory = 0;        // peak memory in bytes without a limit
  uint64_t least_memory = 0;  // smallest feasible limit in bytes
  uint64_t bytes = 0;         // upper bound on the bytes of all coefficients
};

/// Number of points for choosing the order of SRBFs, between the minimum and the default, that keeps the fit within
/// `memory` bytes. Throws Error(unsupported) with the smallest feasible limit.
uint32_t search_points_within(uint64_t memory, const FitExtent& extent);
/// The smallest limit that allows all points, and so gives the same model as no limit.
uint64_t memory_for_all_points(const FitExtent& extent);
/// The smallest feasible limit.
uint64_t memory_for_least_points(const FitExtent& extent);

/// Rounded up to whole megabytes: "17 MB".
std::string megabytes(uint64_t bytes);

/// Memory of a truncated SVD of `extent.coefficients` components.
uint64_t memory_for_components(const FitExtent& extent);
/// Throws Error(unsupported), with the required memory, if such an SVD holds more than `memory` bytes.
void require_components(uint64_t memory, const FitExtent& extent);

/// Maximum number of components, from `least` to `extent.coefficients`, of a truncated SVD within `memory` bytes.
/// Throws Error(unsupported) with the smallest feasible limit.
uint64_t components_within(uint64_t memory, uint64_t least, FitExtent extent);

/// Limits on the data held by a fit of clustered tensors.
struct TensorAllowance {
  size_t point_floats = 16 << 20;         // size of the points from which direction bases are computed
  size_t slices = 6144;                   // texels that are clustered
  uint32_t functions = 640;               // total over all clusters; their products are held for each view
  uint64_t inverse_bytes = ~uint64_t{0};  // of inverse matrices kept while texels are solved for; the rest of the limit
};

/// Memory of a fit with this allowance. `entries`: per slice.
uint64_t memory_for_tensors(const FitExtent& extent, uint64_t entries, const TensorAllowance& allowance);
/// The minimum for any fit.
TensorAllowance least_tensor_allowance();
/// The largest allowance that keeps the fit within `memory` bytes (0: no limit). Throws Error(unsupported) with the
/// smallest feasible limit.
TensorAllowance tensor_allowance(uint64_t memory, const FitExtent& extent, uint64_t entries);

}  // namespace velour
