#include "fit/principled_fit.h"

#include <algorithm>
#include <cmath>

#include "fit/principled_problem.h"

namespace velour {
namespace {

constexpr size_t kRoughnesses = 8;

PrincipledParameters kind(float metallic, float tint, float coat, float coat_roughness) {
  return {.metallic = metallic, .specular_tint = Rgb(tint), .coat = coat, .coat_roughness = coat_roughness};
}

std::vector<PrincipledParameters> kinds_of(PrincipledSet set) {
  if (set == PrincipledSet::plain) {
    return {kind(0, 1, 0, 0.1f), kind(0.3f, 1, 0, 0.1f), kind(0.7f, 1, 0, 0.1f), kind(1, 1, 0, 0.1f)};
  }
  return {kind(0, 1, 0, 0.1f),           kind(0, 1, 1, 0.3f),          kind(1, 1, 0, 0.1f),
          kind(1, 1, 0.5f, 0.15f),       kind(0.3f, 0.5f, 0.3f, 0.3f), kind(0.3f, 0.5f, 0.5f, 0.5f),
          kind(0.7f, 0.5f, 0.05f, 0.1f), kind(0.7f, 0.5f, 0.3f, 0.3f)};
}

/// kRoughnesses starts per kind, kind by kind. Kinds lie at the ends of the ranges and between them: a weight of 0
/// hides the parameters of the layer it weights, and some descents get stuck there.
std::vector<PrincipledParameters> starts(PrincipledSet set) {
  std::vector<PrincipledParameters> out;
  for (PrincipledParameters p : kinds_of(set)) {
    for (size_t i = 0; i < kRoughnesses; ++i) {
      p.roughness = 0.08f * std::pow(1 / 0.08f, static_cast<float>(i) / (kRoughnesses - 1));
      out.push_back(p);
    }
  }
  return out;
}

using Candidates = std::vector<Candidate<PrincipledParameters>>;

Candidates best_of_each_kind(const Candidates& all) {
  Candidates best;
  for (auto kind = all.begin(); kind != all.end(); kind += kRoughnesses) {
    best.push_back(*std::min_element(kind, kind + kRoughnesses, better<PrincipledParameters>));
  }
  return best;
}

}  // namespace

PrincipledParameters fit_principled(const Measurement& measurement, PrincipledSet set, int threads,
                                    Progress& progress) {
  PairSamples samples = pair_samples(measurement, threads, progress);
  if (samples.samples.empty()) return {.base_color = Rgb(0), .specular = 0};
  const PrincipledProblem problem(std::move(samples), set);
  const std::vector<PrincipledParameters> from = starts(set);
  const auto scanned = judged(problem, std::span(from), threads, progress);
  return best_descent(problem, best_of_each_kind(scanned), threads, progress);
}

}  // namespace velour
