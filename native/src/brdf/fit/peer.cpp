#include "brdf/fit/peer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "brdf/fit/ggx_fit.h"
#include "material/principled/principled_material.h"

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

namespace {

constexpr auto kShape = PrincipledProblem::kShape;
constexpr Eigen::Index kTint = 3, kFirstShape = 6;  // indices of the unknowns

Eigen::Index place(size_t shape) { return kFirstShape + static_cast<Eigen::Index>(shape); }

float& unknown(PrincipledParameters& p, Eigen::Index k) {
  if (k < kTint) return p.base_color[static_cast<int>(k)];
  if (k < kFirstShape) return p.specular_tint[static_cast<int>(k - kTint)];
  return p.*kShape[static_cast<size_t>(k - kFirstShape)];
}

float least(float PrincipledParameters::*which) {
  const bool rough = which == &PrincipledParameters::roughness || which == &PrincipledParameters::coat_roughness;
  return rough ? kMinRoughness : 0;
}

// What moves at once for a derivative: the base color, the specular tint, or one of kShape.
constexpr int kColors = 2, kMoves = kColors + static_cast<int>(kShape.size());

/// The unknown that `move` moves in a channel.
constexpr Eigen::Index unknown_of(int move, int channel) {
  return move < kColors ? kTint * move + channel : kFirstShape + move - kColors;
}

/// Normal equations of one channel, by move.
struct MoveSums {
  std::array<double, kMoves * kMoves> curvature;
  std::array<double, kMoves> slope;

  void add(const std::array<double, kMoves>& row, double residual, double weight) {
    for (size_t j = 0; j < kMoves; ++j) {
      const double weighted = weight * row[j];
      slope[j] += weighted * residual;
      for (size_t k = 0; k < kMoves; ++k) curvature[kMoves * j + k] += weighted * row[k];
    }
  }
};

/// Step of a finite difference at `value` in [0, 1], away from the nearer end and well above the rounding of f.
float difference_of(float value) { return value > 0.5f ? -3e-4f : 3e-4f; }

}  // namespace

PrincipledProblem::PrincipledProblem(PairSamples samples, PrincipledSet set)
    : samples_(std::move(samples.samples)), floor_(samples.floor), set_(set) {
  for (size_t i = 0; i < samples_.size(); ++i) {  // samples are grouped by view
    const DirectionPair& w = samples_[i].w;
    const bool begins = batches_.empty() || batches_.back().wv != w.wv;
    if (begins || batches_.back().wl.count == DirectionBatch::kCapacity) batches_.push_back({w.wv, i, {}});
    batches_.back().wl.push(w.wl);
  }
  for (Batch& batch : batches_) batch.wl.pad();
}

std::vector<Rgb> PrincipledProblem::values(const PrincipledParameters& p) const {
  std::vector<Rgb> out(samples_.size());
  RgbBatch f;
  ScalarBatch pdf;
  PrincipledPoint point;
  Vec3 wv(0);
  for (const Batch& batch : batches_) {
    if (batch.wv != wv) point = PrincipledPoint(p, wv = batch.wv);
    eval_principled(point, wv, batch.wl, f, pdf);
    for (int i = 0; i < batch.wl.count; ++i) out[batch.first + static_cast<size_t>(i)] = f.get(i) * batch.wl.z[i];
  }
  return out;
}

double PrincipledProblem::cost(const PrincipledParameters& p) const {
  const std::vector<Rgb> f_cos = values(p);
  double sum = 0;
  for (size_t i = 0; i < f_cos.size(); ++i) {
    const PairSample& s = samples_[i];
    const Rgb difference = glm::sqrt(f_cos[i] + floor_) - glm::sqrt(s.f_cos + floor_);
    sum += s.weight * glm::dot(difference, difference);
  }
  return sum;
}

PrincipledParameters PrincipledProblem::completed(const PrincipledParameters& start) const {
  PrincipledParameters p = start;
  p.base_color = Rgb(0);
  const std::vector<Rgb> black = values(p);
  p.base_color = Rgb(1);
  const std::vector<Rgb> white = values(p);
  for (int c = 0; c < 3; ++c) {
    double top = 0, bottom = 0;
    for (size_t i = 0; i < black.size(); ++i) {
      const PairSample& s = samples_[i];
      const double tinted = white[i][c] - black[i][c];
      const double weight = s.weight / (s.f_cos[c] + floor_);  // g'(y)^2 up to a factor
      top += weight * tinted * (s.f_cos[c] - black[i][c]);
      bottom += weight * tinted * tinted;
    }
    p.base_color[c] = bottom > 0 ? std::clamp(static_cast<float>(top / bottom), 0.0f, 1.0f) : 0.5f;
  }
  return p;
}

PrincipledProblem::Normal PrincipledProblem::normal(const PrincipledParameters& p) const {
  // A channel of f depends on the same channel of a color alone, so each color moves as one.
  const std::vector<Rgb> f_cos = values(p);
  std::array<std::vector<Rgb>, kMoves> slopes;
  for (int move = 0; move < kMoves; ++move) {
    if (is_fixed(unknown_of(move, 0))) continue;
    PrincipledParameters other = p;
    Rgb difference;
    for (int c = 0; c < 3; ++c) {
      float& moved = unknown(other, unknown_of(move, c));
      if (c == 0 || move < kColors)
        moved += difference[c] = difference_of(moved);
      else
        difference[c] = difference[0];
    }
    std::vector<Rgb>& slope = slopes[static_cast<size_t>(move)] = values(other);
    for (size_t i = 0; i < f_cos.size(); ++i) slope[i] = (slope[i] - f_cos[i]) / difference;
  }
  std::array<MoveSums, 3> sums{};
  for (size_t i = 0; i < f_cos.size(); ++i) {
    const PairSample& s = samples_[i];
    for (int c = 0; c < 3; ++c) {
      const float root = std::sqrt(f_cos[i][c] + floor_);
      const double half = 0.5 / root;
      std::array<double, kMoves> row{};
      for (size_t move = 0; move < kMoves; ++move) {
        if (!slopes[move].empty()) row[move] = half * slopes[move][i][c];
      }
      sums[static_cast<size_t>(c)].add(row, static_cast<double>(root) - std::sqrt(s.f_cos[c] + floor_), s.weight);
    }
  }
  Normal n(kSize);
  for (int c = 0; c < 3; ++c) {
    const MoveSums& of_channel = sums[static_cast<size_t>(c)];
    for (int j = 0; j < kMoves; ++j) {
      n.slope[unknown_of(j, c)] += of_channel.slope[static_cast<size_t>(j)];
      for (int k = 0; k < kMoves; ++k)
        n.curvature(unknown_of(j, c), unknown_of(k, c)) += of_channel.curvature[static_cast<size_t>(j * kMoves + k)];
    }
  }
  freeze_at_bounds(p, n);
  for (int k = 0; k < kSize; ++k) {
    if (is_fixed(k)) n.freeze(k);
  }
  return n;
}

bool PrincipledProblem::is_fixed(Eigen::Index k) const {
  if (set_ == PrincipledSet::all || k < kTint) return false;
  if (k < kFirstShape) return true;
  const auto which = kShape[static_cast<size_t>(k - kFirstShape)];
  return which == &PrincipledParameters::coat || which == &PrincipledParameters::coat_roughness;
}

void PrincipledProblem::freeze_at_bounds(const PrincipledParameters& p, Normal& n) const {
  const auto check = [&n](Eigen::Index i, float value, float least) {
    if ((value <= least && n.slope[i] > 0) || (value >= 1 && n.slope[i] < 0)) n.freeze(i);
  };
  for (int c = 0; c < 3; ++c) {
    check(c, p.base_color[c], 0);
    check(kTint + c, p.specular_tint[c], 0);
  }
  for (size_t k = 0; k < kShape.size(); ++k) check(place(k), p.*kShape[k], least(kShape[k]));
}

PrincipledParameters PrincipledProblem::moved(const PrincipledParameters& p,
                                              const decltype(Normal::slope)& step) const {
  constexpr double kReach = 0.2;  // the linear model holds no further
  PrincipledParameters to = p;
  const auto move = [&step, kReach](float& value, Eigen::Index at, float lowest) {
    value = std::clamp(value + static_cast<float>(std::clamp(step[at], -kReach, kReach)), lowest, 1.0f);
  };
  for (int c = 0; c < 3; ++c) {
    move(to.base_color[c], c, 0);
    move(to.specular_tint[c], kTint + c, 0);
  }
  for (size_t k = 0; k < kShape.size(); ++k) move(to.*kShape[k], place(k), least(kShape[k]));
  return to;
}

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
