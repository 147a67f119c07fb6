// The verdict on a fit: whether pictures of the model look like pictures of the measurement.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace velour {

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

}  // namespace velour
