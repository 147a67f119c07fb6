// A fit of a BTF that can be made at many sizes.
#pragma once

#include <string>
#include <vector>

#include "compress/btf_fit_options.h"
#include "job/progress.h"
#include "model/model.h"

namespace velour {

/// What is common to all sizes - colours, and in which order functions are worth their bytes - is found once, when it
/// is constructed; a model of one size is what fit() makes.
class BtfFitter {
 public:
  virtual ~BtfFitter() = default;

  /// A point a size, rising. `relative_l2`: what the method expects of it before it is fitted, in companded values;
  /// `parameter_bytes`: at most.
  const OrderCurve& curve() const { return curve_; }
  /// The number of the largest point within the bytes that were asked for.
  size_t largest() const { return largest_; }
  /// Of the model at a point. Deterministic; the same bits for any number of threads.
  virtual ModelBody fit(size_t point) = 0;
  /// Shapes of clustered tensors that were tried.
  const std::vector<ShapeTrial>& shapes() const { return shapes_; }
  /// Entries of the measurement that were left out.
  uint64_t not_finite() const { return not_finite_; }
  /// What else is to be said of the models.
  const std::vector<std::string>& warnings() const { return warnings_; }

 protected:
  /// Sets largest(). Throws Error(invalid_argument), with what `one` takes, when not even the first point is within.
  void bound(uint64_t bytes, const char* one);

  OrderCurve curve_;
  size_t largest_ = 0;
  std::vector<ShapeTrial> shapes_;
  uint64_t not_finite_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace velour
