#include "brdf/fit/peer.h"

#include <chrono>

#include "brdf/fit/ggx_fit.h"
#include "brdf/fit/principled_fit.h"
#include "material/principled/principled_material.h"

namespace velour {
namespace {

std::shared_ptr<const Material> make(const GgxParameters& p) { return make_ggx_material(p); }
std::shared_ptr<const Material> make(const PrincipledParameters& p) { return make_principled_material(p); }

}  // namespace

PeerParameters fit_peer(const Measurement& measurement, Peer peer, int threads, Progress& progress) {
  if (peer == Peer::ggx) return fit_ggx(measurement, threads, progress);
  const auto set = peer == Peer::principled ? PrincipledSet::all : PrincipledSet::plain;
  return fit_principled(measurement, set, threads, progress);
}

std::shared_ptr<const Material> make_peer_material(const PeerParameters& parameters) {
  return std::visit([](const auto& p) { return make(p); }, parameters);
}

uint64_t PeerFit::parameter_bytes() const {
  return std::visit([](const auto& p) -> uint64_t { return sizeof p; }, parameters);
}

PeerFit judge_peer(const Measurement& measurement, Peer peer, int threads, Progress& progress) {
  PeerFit out;
  progress.stage(peer == Peer::ggx ? "fitting GGX" : "fitting Principled BSDF", 0, 0.5);
  const auto start = std::chrono::steady_clock::now();
  out.parameters = fit_peer(measurement, peer, threads, progress);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.stage("comparing", 0.5, 1);
  out.error = compare(measurement, *make_peer_material(out.parameters), progress);
  return out;
}

}  // namespace velour
