// Analytic materials to compare a fitted model with: fitted to the same measurement and judged in the same way.
#pragma once

#include <memory>
#include <variant>

#include "base/progress.h"
#include "brdf/fit/error/compare.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"
#include "material/principled/principled_point.h"

namespace velour {

enum class Peer { ggx, principled, plain_principled };
using PeerParameters = std::variant<GgxParameters, PrincipledParameters>;

/// The peer with the parameters that fit the measurement best. The result does not depend on `threads` (0: all).
PeerParameters fit_peer(const Measurement& measurement, Peer peer, int threads, Progress& progress);

std::shared_ptr<const Material> make_peer_material(const PeerParameters& parameters);

/// A fitted peer, and its error as docs/engine/conventions.md defines it for any model.
struct PeerFit {
  PeerParameters parameters;
  double seconds = 0;  // of the fit
  Comparison error;

  /// Bytes of the parameter struct.
  uint64_t parameter_bytes() const;
};
PeerFit judge_peer(const Measurement& measurement, Peer peer, int threads, Progress& progress);

}  // namespace velour
