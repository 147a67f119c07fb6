// Warnings about measurements, fits, models, scenes, images and captures: a code and named values.
//
// The library has no sentences for them. addon/velour/core/warning_table.py has one per code, for panels, command line
// and reports.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace velour {

// X(code, "names of its values"). Files and JSON contain codes and names, so these never change. Angles are in degrees,
// lengths in meters, shares from 0 to 1, changes and errors relative L2. `view` and `views` are polar angles, `azimuth`
// and `azimuths` are empty for isotropic measurements; a list of azimuths has one per view.
#define VELOUR_WARNINGS(X)                                                                                            \
  /* Measurements */                                                                                                  \
  X(invalid_entries, "invalid entries")                                                                               \
  X(spikes_left_out, "spikes samples")                                                                                \
  X(few_samples, "samples judged held_out") /* held_out 1: errors are measured on held-out samples; 0: on fitted */   \
  X(anisotropic_samples, "pairs factor same_azimuth_factor")                                                          \
  X(noise_exceeds_tolerance, "count worst difference") /* worst: the view with the largest noise */                   \
  X(narrow_highlight, "views share") /* only in older files; share: of the energy, captured by even directions */     \
  X(partial_coverage, "views share") /* share: of the light directions, at the view with the smallest */              \
  X(no_view_covered, "")                                                                                              \
  X(black_measurement, "")                                                                                            \
  X(dark_measurement, "albedo")                                                                                       \
  X(measurement_not_reciprocal, "change")                                                                             \
  X(implausible_albedo, "albedo view azimuth")                                                                        \
  X(measured_albedo_above_one, "albedo view azimuth")                                                                 \
  X(views_left_out, "uncovered sampled")                                                                              \
  X(out_of_gamut, "outside values error")                                                                             \
  X(repeated_directions, "views lights")                                                                              \
  X(images_outside_folder, "index outside images first")                                                              \
  X(images_channels_ignored, "images all first layer channels") /* layer and channels: of the first image */          \
  X(images_parts_ignored, "images all first part parts")                                                              \
  X(images_channel_missing, "images all first")                                                                       \
  X(images_color_space_ignored, "images all first space")                                                             \
  X(values_not_finite, "values")                                                                                      \
  /* Fits and models */                                                                                               \
  X(views_exceed_tolerance, "views errors tolerance") /* reported views; the tolerance is twice as large beyond 75 */ \
  X(views_not_covered, "views")                                                                                       \
  X(fitted_views_exceed_tolerance,                                                                                    \
    "views azimuths missed fitted lobes worst worst_azimuth error tolerance") /* views: the first 12 */               \
  X(black_model, "")                                                                                                  \
  X(model_not_reciprocal, "change")                                                                                   \
  X(model_albedo_above_one, "albedo view azimuth measured")                                                           \
  X(model_bounded, "bytes views lobes")                                                                               \
  X(roughened, "roughness")                                                                                           \
  X(tolerance_needs_bytes, "tolerance error bytes enough")                                                            \
  X(tolerance_needs_more_bytes, "tolerance error bytes largest reachable") /* reachable: a tolerance */               \
  X(tolerance_out_of_reach, "tolerance error bytes reachable")                                                        \
  X(memory_limits_fit, "points usual memory")                                                                         \
  X(fit_not_resumed, "reason")                                                                                        \
  X(checkpoint_not_written, "reason")                                                                                 \
  X(scene_needs_full_model, "")                                                                                       \
  X(scene_shows_finest_texels, "")                                                                                    \
  X(only_finest_levels_left_out, "")                                                                                  \
  /* Captures */                                                                                                      \
  X(tile_seam, "axis jump share rms thickness inside") /* axis: "x" or "y"; rms in scene units, as thickness */       \
  X(tile_emits_light, "")                                                                                             \
  X(tile_is_transparent, "")                                                                                          \
  X(sheets_thickened, "lines sampled")                                                                                \
  X(silhouette_differs, "wrong")                                                                                      \
  X(rays_lost, "rays")                                                                                                \
  X(path_values_not_finite, "values")                                                                                 \
  /* Scenes */                                                                                                        \
  X(triangles_left_out, "mesh triangles")                                                                             \
  X(flat_instances_left_out, "instances")                                                                             \
  X(silhouettes_without_uvs, "instances")                                                                             \
  X(silhouette_folds, "material bottom top triangles sampled radius tile")                                            \
  X(no_light, "")                                                                                                     \
  X(faces_without_normals, "file faces all")                                                                          \
  X(faces_without_uvs, "file faces all")                                                                              \
  X(faces_left_out, "file faces")                                                                                     \
  /* Images; an empty file: the environment image */                                                                  \
  X(channels_ignored, "file layer channels")                                                                          \
  X(parts_ignored, "file part parts")                                                                                 \
  X(channel_missing, "file")                                                                                          \
  X(xyz_as_rgb, "file")                                                                                               \
  X(orientation_ignored, "file orientation") /* EXIF tag 274 */                                                       \
  X(exposure_ignored, "file")                                                                                         \
  X(primaries_ignored, "file")                                                                                        \
  X(color_space_ignored, "file space")                                                                                \
  X(window_ignored, "file width height")                                                                              \
  X(infinite_values, "file values replacement")                                                                       \
  X(nan_values, "file values")                                                                                        \
  X(negative_values, "file values")                                                                                   \
  /* Model files of other versions */                                                                                 \
  X(stored_sentence, "text") /* written when files contained sentences */                                             \
  X(unknown_warning, "code") /* written by a later version */

enum class WarningCode : uint8_t {
#define VELOUR_WARNING_CODE(code, names) code,
  VELOUR_WARNINGS(VELOUR_WARNING_CODE)
#undef VELOUR_WARNING_CODE
};

struct WarningKind {
  std::string_view key;
  std::string_view names;  // separated by blanks

  constexpr size_t count() const {
    size_t count = names.empty() ? 0 : 1;
    for (const char c : names) count += c == ' ';
    return count;
  }
  constexpr bool has(std::string_view name) const {
    for (size_t begin = 0; begin < names.size();) {
      const size_t end = std::min(names.find(' ', begin), names.size());
      if (names.substr(begin, end - begin) == name) return true;
      begin = end + 1;
    }
    return false;
  }
};

inline constexpr auto kWarningKinds = std::to_array<WarningKind>({
#define VELOUR_WARNING_KIND(code, names) {#code, names},
    VELOUR_WARNINGS(VELOUR_WARNING_KIND)
#undef VELOUR_WARNING_KIND
});

constexpr const WarningKind& kind_of(WarningCode code) { return kWarningKinds[static_cast<size_t>(code)]; }

using WarningValue = std::variant<uint64_t, double, std::string, std::vector<double>, std::vector<std::string>>;

/// Make one with warning<code>(), which checks the names.
struct Warning {
  WarningCode code;
  std::vector<std::pair<std::string, WarningValue>> values;

  bool operator==(const Warning&) const = default;
};

/// A value of warnings of this code. Other names do not compile.
template <WarningCode code>
struct NamedValue {
  struct Name {
    consteval Name(const char* name) : text(name) {
      if (!kind_of(code).has(name)) throw "This warning has no value of this name.";
    }
    const char* text;
  };
  Name name;
  WarningValue value;
};

/// warning<WarningCode::few_samples>({{"samples", 40}, ...}), with all of its values.
template <WarningCode code, size_t N>
Warning warning(NamedValue<code> (&&values)[N]) {
  static_assert(N == kind_of(code).count(), "A warning needs all of its values.");
  Warning warning{code, {}};
  for (NamedValue<code>& v : values) warning.values.emplace_back(v.name.text, std::move(v.value));
  return warning;
}
template <WarningCode code>
Warning warning() {
  static_assert(kind_of(code).count() == 0, "A warning needs all of its values.");
  return {code, {}};
}

/// [{"code": key, "values": {name: value}}, ...]; fractions have four significant digits.
nlohmann::ordered_json warnings_json(const std::vector<Warning>& warnings);

/// The keys of a record in a model file: "warnings" has the stored sentences, "warning_codes" all others.
void put_warnings(const std::vector<Warning>& warnings, nlohmann::ordered_json& record);
/// Reads both keys; a missing one is empty. Throws Error(bad_data) with `where` (file and attribute) and the key at
/// fault.
std::vector<Warning> parse_warnings(const nlohmann::ordered_json& record, const std::string& where);

}  // namespace velour
