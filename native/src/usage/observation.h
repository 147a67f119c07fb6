// Scene usage of a material, in enough detail to predict how an image changes with the material's model.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "math/sphere/vec.h"
#include "usage/scene_domain.h"

namespace velour {

/// A hit and its incident light. Terms [first, middle) and [middle, last) are two independent estimates of the light,
/// so the product of the changes that a change of f causes in them has the square of the true change as its
/// expectation.
struct ObservedHit {
  uint64_t key;  // hits with the smallest keys are kept; the bits of a time (scene_observer.h)
  Vec3 wv;       // local frame
  uint32_t first, middle, last;
  float light_density = 0;  // 1/sr: SceneDomain::light_density for this hit alone
  bool back = false;        // SurfaceSite::back; z of wv and of the terms is then positive on the back
};

/// Hits are sampled with probability proportional to their weight (SceneDomain), so all count equally.
struct SceneObservation {
  static constexpr size_t kHits = 1024;

  SceneDomain domain;
  std::vector<ObservedHit> hits;  // in ascending order of key
  // Terms of all hits. The sum of f(wl) . light over one half of a hit's terms estimates the radiance leaving the hit.
  std::vector<Vec3> wl;    // local frame; below the horizon for transmitted light
  std::vector<Rgb> light;  // radiance x cos / density / number of terms, shadows included; Rec. 709 or working space
};

/// Polar angle of a view above the horizon, radians; SceneDomain::view is binned by it.
inline double theta_of(const Vec3& wv) { return std::acos(std::min(1.0, static_cast<double>(wv.z))); }

/// Copy without light from the other side of the surface: the part that a purely reflective material responds to.
SceneObservation reflected_part(const SceneObservation& observation);

/// Adds the observation of another frame or scene and keeps the kHits hits with the smallest keys. The result does not
/// depend on the order of frames.
void merge(SceneObservation& into, const SceneObservation& other);

// Whether a frame stays within the scene usage that a material's model was reduced to.

/// Share of the material's weight in the image of `frame` that lies outside: seen from a view outside `range`, or from
/// a view inside it under light more than kSharperLight times as concentrated as in `domain`. 0..1; 0 for a frame that
/// never shows the material.
///
/// The two parts are disjoint, so they add up. The first is computed from the view histogram of all hits, in which a
/// single one of 65,536 camera rays counts. The second is computed from the kept hits, each an independent sample by
/// weight: a true share p is estimated with a standard deviation of sqrt(p (1 - p) / 1024), 0.1 % of the image at p =
/// 0.1 %. Light that sharp on 0.1 % of the weight is missed in 36 frames of 100, on 0.5 % in one of 170.
double out_of_domain(const SceneDomain& domain, const ViewRange& range, const SceneObservation& frame);

/// For a BTF model that knows only the views of `domain`: share of the weight that is seen from elsewhere
/// (share_from_elsewhere).
double out_of_views(const SceneDomain& domain, const SceneObservation& frame);

/// For a BTF model whose finest level has `texels` along the longer side of the tile: share of the weight that would
/// look up a finer level. Computed from all hits; 1 for a frame that shows the material but has no footprints.
double out_of_resolution(uint32_t texels, const SceneObservation& frame);

// Content hash of an observation.

/// SHA-256 of the view histogram, the light density, the surface usage if there is any, and the hits with their terms,
/// as four words. For the domain of one frame; merging adds the words up.
std::array<uint64_t, 4> content_hash(const SceneObservation& observation);

// The four words of a domain's hash as 64 hexadecimal digits, first word first.

std::string hash_text(const std::array<uint64_t, 4>& hash);

/// Empty unless `text` consists of 64 digits 0-9, a-f.
std::optional<std::array<uint64_t, 4>> parse_hash(std::string_view text);

// Observation files: JSON with readable numbers; hits and their terms are base64
// (docs/reference/measurement_formats.md).

/// All numbers survive a round trip bit by bit.
std::string encode_observation(const SceneObservation& observation);

/// Throws Error(bad_data), or Error(version_mismatch) for another version of the format. The message names the file
/// (`name`) and the field at fault.
SceneObservation decode_observation(std::span<const uint8_t> bytes, const std::string& name);

/// Writes atomically.
void save_observation(const SceneObservation& observation, const std::string& path);
SceneObservation load_observation(const std::string& path);

/// Whether the file begins like the JSON of an observation; the rest may still be damaged.
bool is_observation_file(const std::string& path);

}  // namespace velour
