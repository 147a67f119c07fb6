// Error of a fit over the size of its model, and the chosen size.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>
#include "usage/scene_domain.h"

namespace velour {

/// The best fit found with at most this many lobes.
struct OrderPoint {
  int lobes = 0;  // per-view model: of the view with the most; parametric: in total
  uint64_t parameter_bytes = 0;
  double worst = 0;  // largest relative L2 of a fitted view over its tolerance, which the folding error reduces; at
                     // most 1 if the fit meets it
  double relative_l2 = 0;  // mean over the fitted views, weighted as the fit does

  bool operator==(const OrderPoint&) const = default;
};

struct OrderCurve {
  std::vector<OrderPoint> points;  // in the order of parameter_bytes; empty: not recorded
  std::optional<size_t> chosen;    // the point of the stored model

  bool operator==(const OrderCurve&) const = default;
};

// Scene usage that a model was reduced to, and the resulting errors.

/// Errors are relmse at the observed hits, against the measurement (usage/picture_error.h, usage/btf/seen_pictures.h).
struct SceneRecord {
  SceneDomain domain;
  double picture_error = 0;       // relmse of this model
  double full_picture_error = 0;  // relmse of the full model
  uint64_t full_parameter_bytes = 0;
  /// For a BTF: texels along x and y at the full model's finest level. Levels finer than its own grid are dropped.
  std::array<uint32_t, 2> full_texels{};
  /// For a BTF: fitted only to the observed views and those around them, with errors. False: only levels were dropped,
  /// the model is valid for all views, and the errors are 0.
  bool seen_views_alone = false;
};

}  // namespace velour
