#include "fit/principled_problem.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr auto kShape = PrincipledProblem::kShape;
constexpr Eigen::Index kTint = 3, kFirstShape = 6;  // places among the unknowns

Eigen::Index place(size_t shape) { return kFirstShape + static_cast<Eigen::Index>(shape); }

float least(float PrincipledParameters::*which) {
  const bool rough = which == &PrincipledParameters::roughness || which == &PrincipledParameters::coat_roughness;
  return rough ? kMinRoughness : 0;
}

/// What a derivative at `value` in [0, 1] looks ahead, away from the nearer end: well above the rounding of f.
float difference_of(float value) { return value > 0.5f ? -1e-3f : 1e-3f; }

}  // namespace

PrincipledProblem::PrincipledProblem(PairSamples samples, PrincipledSet set)
    : samples_(std::move(samples.samples)), floor_(samples.floor), set_(set) {
  for (const PairSample& s : samples_) h_.push_back(glm::normalize(s.w.wl + s.w.wv));
}

std::vector<PrincipledProblem::Parts> PrincipledProblem::parts(const PrincipledLobes& lobes) const {
  std::vector<Parts> out;
  out.reserve(samples_.size());
  PrincipledLobes::View view{};
  for (size_t i = 0; i < samples_.size(); ++i) {
    const DirectionPair& w = samples_[i].w;
    if (view.wv != w.wv) view = lobes.view(w.wv);  // samples come a view at a time
    out.push_back(lobes.parts(view, w.wl, h_[i]));
  }
  return out;
}

double PrincipledProblem::cost(const PrincipledParameters& p) const {
  const PrincipledLobes lobes(p);
  const std::vector<Parts> f = parts(lobes);
  double sum = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    const PairSample& s = samples_[i];
    const Rgb difference = glm::sqrt(lobes.value(f[i]) * s.w.wl.z + floor_) - glm::sqrt(s.f_cos + floor_);
    sum += s.weight * glm::dot(difference, difference);
  }
  return sum;
}

PrincipledParameters PrincipledProblem::completed(const PrincipledParameters& start) const {
  const std::vector<Parts> f = parts(PrincipledLobes(start));
  PrincipledParameters p = start;
  for (int c = 0; c < 3; ++c) {
    double top = 0, bottom = 0;
    for (size_t i = 0; i < f.size(); ++i) {
      const PairSample& s = samples_[i];
      // Linear in the base colour but where a strong tint has been clamped.
      const float black = PrincipledLobes::value(f[i], 0, p.specular_tint[c]);
      const double tinted = (PrincipledLobes::value(f[i], 1, p.specular_tint[c]) - black) * s.w.wl.z;
      const double weight = s.weight / (s.f_cos[c] + floor_);  // g'(y)^2 but for a factor
      top += weight * tinted * (s.f_cos[c] - black * s.w.wl.z);
      bottom += weight * tinted * tinted;
    }
    p.base_color[c] = bottom > 0 ? std::clamp(static_cast<float>(top / bottom), 0.0f, 1.0f) : 0.5f;
  }
  return p;
}

std::array<std::vector<PrincipledProblem::Parts>, kShape.size()> PrincipledProblem::parts_beside(
    const PrincipledParameters& p, const PrincipledLobes& lobes) const {
  std::array<std::vector<Parts>, kShape.size()> beside;
  for (size_t k = 0; k < kShape.size(); ++k) {
    PrincipledParameters other = p;
    other.*kShape[k] += difference_of(p.*kShape[k]);
    beside[k] = parts(lobes.with(other));
  }
  return beside;
}

PrincipledProblem::Normal PrincipledProblem::normal(const PrincipledParameters& p) const {
  const PrincipledLobes lobes(p);
  const std::vector<Parts> f = parts(lobes);
  const auto beside = parts_beside(p, lobes);
  Normal n(kSize);
  for (size_t i = 0; i < f.size(); ++i) {
    const PairSample& s = samples_[i];
    for (int c = 0; c < 3; ++c) {
      const float base = p.base_color[c], tint = p.specular_tint[c], value = PrincipledLobes::value(f[i], base, tint);
      const auto slope = [value](float other, float at) { return (other - value) / difference_of(at); };
      Eigen::Matrix<double, kSize, 1> row = Eigen::Matrix<double, kSize, 1>::Zero();
      row[c] = slope(PrincipledLobes::value(f[i], base + difference_of(base), tint), base);
      row[kTint + c] = slope(PrincipledLobes::value(f[i], base, tint + difference_of(tint)), tint);
      for (size_t k = 0; k < kShape.size(); ++k) {
        row[place(k)] = slope(PrincipledLobes::value(beside[k][i], base, tint), p.*kShape[k]);
      }
      const float root = std::sqrt(value * s.w.wl.z + floor_);
      const double residual = static_cast<double>(root) - std::sqrt(s.f_cos[c] + floor_);
      row *= 0.5 * s.w.wl.z / root;
      n.curvature.noalias() += s.weight * row * row.transpose();
      n.slope.noalias() += s.weight * residual * row;
    }
  }
  freeze_at_bounds(p, n);
  freeze_others(n);
  return n;
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

void PrincipledProblem::freeze_others(Normal& n) const {
  if (set_ == PrincipledSet::all) return;
  for (int c = 0; c < 3; ++c) n.freeze(kTint + c);
  for (size_t k = 0; k < kShape.size(); ++k) {
    if (kShape[k] == &PrincipledParameters::coat || kShape[k] == &PrincipledParameters::coat_roughness) {
      n.freeze(place(k));
    }
  }
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

}  // namespace velour
