// Records of a fit: error over size, the verdict of pictures, quality relative to the source.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>
#include "base/warning.h"
#include "usage/scene_domain.h"

namespace velour {

// Error of a fit over the size of its model, and the chosen size.

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

/// Errors are relmse at the observed hits, against the measurement (usage/picture_error.h,
/// usage/btf/scene_reduction.h).
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

// The verdict on a fit: whether pictures of the model look like pictures of the measurement.

enum class LookQuality : uint8_t { good, fair, poor };

/// What pictures differ in most. Files contain the names, so these never change; append new ones.
enum class LookReason : uint8_t {
  none,               // of good fits; or of a later version of Velour
  grazing_views,      // value: the polar angle (degrees) beyond which they differ
  highlights,         // bright parts; value 0
  brightness,         // value: mean luminance of the model's pictures over that of the measurement's
  color,              // value 0
  everywhere,         // value 0
  measurement_noise,  // value: mean FLIP against the mean of the measurement and itself with light and view exchanged
  unresolved_highlights,  // by irregular samples; value: the angle between those, degrees
  anisotropic_samples,    // of an isotropic fit; value 0
  held_out_samples,       // value: the relative L2 error at the view where they are missed most
};

struct Verdict {
  LookQuality quality = LookQuality::good;
  double flip_mean = 0, flip_95 = 0;  // over all pixels of the pictures: mean and 95th percentile of FLIP
  LookReason reason = LookReason::none;
  double value = 0;  // see LookReason

  bool operator==(const Verdict&) const = default;
};

/// {"quality": "good" | "fair" | "poor", "flip_mean": 0.02, "flip_95": 0.08, "reason": name or null, "value": 0};
/// numbers have four significant digits.
nlohmann::ordered_json verdict_json(const Verdict& verdict);

/// Throws Error(bad_data) with `where` (file and field) and the key at fault. A reason that this version does not know
/// becomes LookReason::none.
Verdict parse_verdict(const nlohmann::ordered_json& json, const std::string& where);

// Quality of a fitted BTF relative to its source.

/// One fit of the search for a size.
struct SizeTrial {
  int coefficients = 0;  // per texel, of the side with the most; for an SVD, components
  uint64_t parameter_bytes = 0;
  double expected = 0;     // relative L2 error before the fit
  double relative_l2 = 0;  // measured

  bool operator==(const SizeTrial&) const = default;
};

/// A shape of clustered tensors that was tried before the fit.
struct ShapeTrial {
  uint32_t clusters = 0, members = 0;
  std::array<uint32_t, 4> rank{};  // of texels, views, lights, colors
  uint64_t parameter_bytes = 0;
  double expected = 0;  // relative L2 error, over the texels of the trial

  bool operator==(const ShapeTrial&) const = default;
};

struct BtfRecord {
  std::string method;                                  // "svd", "srbf", "tucker", "cta", "kcta"
  double psnr = 0;                                     // dB, over all fitted pairs (docs/engine/conventions.md)
  std::optional<double> psnr_held_out = std::nullopt;  // dB, over held-out pairs
  double ser = 0;                                      // squared error of f cos(theta_l) over its sum of squares
  double p99 = 0;                     // 99th percentile of the measurement's f, 1/sr: the white of `psnr`
  uint64_t raw_bytes = 0;             // size of the measurement as half floats
  double seconds = 0;                 // wall clock of the fit
  double evaluations_per_second = 0;  // per CPU second of one thread, at random places and directions; 0: not measured
  uint64_t seed = 0;
  std::vector<Warning> warnings;
  double relative_l2 = 0;                         // of companded values over all fitted pairs; 0: not measured
  double tolerance = 0;                           // requested maximum of relative_l2; 0: none
  OrderCurve order;                               // error over size; `lobes` are coefficients per texel, or components
  std::vector<SizeTrial> search;                  // in the order of the fits
  std::vector<ShapeTrial> shapes;                 // of clustered tensors, in the order of the trials
  std::optional<Verdict> verdict = std::nullopt;  // none: not judged (verdict/btf_verdict.h)
};

/// [{"coefficients", "parameter_bytes", "expected", "relative_l2"}, ...], errors with four digits.
nlohmann::ordered_json trials_json(const std::vector<SizeTrial>& trials);

/// [{"clusters", "members", "texel_rank", "view_rank", "light_rank", "color_rank", "parameter_bytes", "expected"}, ...]
nlohmann::ordered_json shapes_json(const std::vector<ShapeTrial>& shapes);

/// JSON, for an attribute of the model file.
std::string btf_record_json(const BtfRecord& record);
/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault.
BtfRecord parse_btf_record(const std::string& text, const std::string& where);

}  // namespace velour
