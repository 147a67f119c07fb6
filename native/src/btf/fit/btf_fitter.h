// Base of BTF fits that can be made at many sizes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include "base/progress.h"
#include "base/warning.h"
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
  void bound(uint64_t bytes, const char* one);

  OrderCurve curve_;
  size_t largest_ = 0;
  std::vector<ShapeTrial> shapes_;
  uint64_t not_finite_ = 0;
  std::vector<Warning> warnings_;
};

}  // namespace velour
