// A constant and a few SRBFs of wv for every texel: a dictionary's best lobes, one after the other, then descent.
#include <tbb/parallel_for.h>

#include <cmath>
#include <Eigen/Core>
#include <Eigen/QR>
#include <numbers>

#include "math/optimize/levenberg_marquardt.h"
#include "math/sphere/directions.h"
#include "occlusion_candidates.h"

namespace velour {
namespace {

constexpr int kMaxLobes = 4, kMost = 1 + 4 * kMaxLobes;
constexpr double kMinBandwidth = 0.5, kLargestBandwidth = 400, kMaxAmplitude = 4;
constexpr int kAxes = 64;
constexpr double kBandwidths[] = {2, 8, 32, 128};
constexpr size_t kBlock = 512;  // texels

/// constant, then of each lobe: amplitude, axis times bandwidth. A lobe is amplitude exp(a . wv - |a|).
using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1>;
using Row = Eigen::Matrix<double, Eigen::Dynamic, 1>;

struct Problem {
  const std::vector<Vec3>& views;
  const float* level;

  static double lobe(const double* p, const Vec3& w) {
    const double length = std::sqrt(p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    return std::exp(p[1] * static_cast<double>(w.x) + p[2] * static_cast<double>(w.y) +
                    p[3] * static_cast<double>(w.z) - length);
  }
  static double value(const Parameters& p, const Vec3& w) {
    double sum = p[0];
    for (Eigen::Index l = 1; l < p.size(); l += 4) sum += p[l] * lobe(p.data() + l, w);
    return sum;
  }
  double cost(const Parameters& p) const {
    double sum = 0;
    for (size_t i = 0; i < views.size(); ++i) sum += std::pow(value(p, views[i]) - static_cast<double>(level[i]), 2);
    return sum;
  }
  NormalEquations<kMost> normal(const Parameters& p) const {
    NormalEquations<kMost> n(p.size());
    Parameters slope(p.size());
    for (size_t i = 0; i < views.size(); ++i) {
      const Vec3& w = views[i];
      double error = p[0] - static_cast<double>(level[i]);
      slope[0] = 1;
      for (Eigen::Index l = 1; l < p.size(); l += 4) {
        const double g = lobe(p.data() + l, w), length = p.segment<3>(l + 1).norm();
        error += p[l] * g;
        slope[l] = g;
        for (int k = 0; k < 3; ++k) {
          slope[l + 1 + k] = p[l] * g * (static_cast<double>(w[k]) - p[l + 1 + k] / length);
        }
      }
      n.curvature.selfadjointView<Eigen::Lower>().rankUpdate(slope);
      n.slope += error * slope;
    }
    n.curvature.triangularView<Eigen::StrictlyUpper>() = n.curvature.transpose();
    return n;
  }
  static Parameters moved(const Parameters& p, const Parameters& step) {
    Parameters to = p + step;
    to[0] = std::clamp(to[0], -kMaxAmplitude, kMaxAmplitude);
    for (Eigen::Index l = 1; l < p.size(); l += 4) {
      const double length = to.segment<3>(l + 1).norm();
      to[l] = std::clamp(to[l], -kMaxAmplitude, kMaxAmplitude);
      to.segment<3>(l + 1) *= std::clamp(length, kMinBandwidth, kLargestBandwidth) / std::max(length, 1e-9);
    }
    return to;
  }
};

struct Dictionary {
  std::vector<Parameters> atom;  // of one lobe
  Eigen::MatrixXf row;           // [atom][view], mean 0 and square 1
};

Dictionary dictionary(const std::vector<Vec3>& views) {
  Dictionary d;
  for (const Vec3& axis : hemisphere_fibonacci(kAxes)) {
    for (const double bandwidth : kBandwidths) {
      Parameters p(5);
      p << 0, 1, bandwidth * static_cast<double>(axis.x), bandwidth * static_cast<double>(axis.y),
          bandwidth * static_cast<double>(axis.z);
      d.atom.push_back(p);
    }
  }
  d.row.resize(static_cast<Eigen::Index>(d.atom.size()), static_cast<Eigen::Index>(views.size()));
  for (size_t a = 0; a < d.atom.size(); ++a) {
    for (size_t i = 0; i < views.size(); ++i) {
      d.row(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(i)) =
          static_cast<float>(Problem::value(d.atom[a], views[i]));
    }
  }
  d.row.colwise() -= d.row.rowwise().mean();
  d.row.rowwise().normalize();
  return d;
}

/// Adds the atom that explains most of what `p` leaves; all amplitudes and the constant by least squares.
Parameters extended(const Problem& problem, const Dictionary& d, const Parameters& p) {
  const auto views = static_cast<Eigen::Index>(problem.views.size());
  Eigen::VectorXf left(views);
  for (Eigen::Index i = 0; i < views; ++i) {
    left[i] = problem.level[i] - static_cast<float>(Problem::value(p, problem.views[static_cast<size_t>(i)]));
  }
  left.array() -= left.mean();
  Eigen::Index best;
  (d.row * left).cwiseAbs().maxCoeff(&best);
  Parameters more(p.size() + 4);
  more << p, d.atom[static_cast<size_t>(best)].tail<4>();
  const Eigen::Index lobes = (more.size() - 1) / 4;
  Eigen::MatrixXd a(views, 1 + lobes);
  Eigen::VectorXd b(views);
  for (Eigen::Index i = 0; i < views; ++i) {
    const Vec3& w = problem.views[static_cast<size_t>(i)];
    a(i, 0) = 1;
    for (Eigen::Index l = 0; l < lobes; ++l) a(i, 1 + l) = Problem::lobe(more.data() + 1 + 4 * l, w);
    b[i] = static_cast<double>(problem.level[i]);
  }
  const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
  more[0] = x[0];
  for (Eigen::Index l = 0; l < lobes; ++l) more[1 + 4 * l] = x[1 + l];
  return Problem::moved(more, Parameters::Zero(more.size()));
}

/// Parameters as bytes.
struct LobeBytes {
  static constexpr double kOctaves = 10;  // of bandwidths, from 1/2 on

  static uint8_t byte(double share) { return static_cast<uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }
  void append(const Parameters& p, std::vector<uint8_t>& bytes) const {
    bytes.push_back(byte(0.5 + 0.5 * p[0] / kMaxAmplitude));
    for (Eigen::Index l = 1; l < p.size(); l += 4) {
      const double length = p.segment<3>(l + 1).norm();
      bytes.push_back(byte(0.5 + 0.5 * p[l] / kMaxAmplitude));
      bytes.push_back(byte(std::acos(std::clamp(p[l + 3] / length, -1.0, 1.0)) / std::numbers::pi));
      bytes.push_back(byte(0.5 + 0.5 * std::atan2(p[l + 2], p[l + 1]) / std::numbers::pi));
      bytes.push_back(byte((1 + std::log2(length)) / kOctaves));
    }
  }
  Parameters parameters(const uint8_t* bytes, int lobes) const {
    const auto share = [](uint8_t b) { return b / 255.0; };
    Parameters p(1 + 4 * lobes);
    p[0] = kMaxAmplitude * (2 * share(*bytes++) - 1);
    for (Eigen::Index l = 1; l < p.size(); l += 4, bytes += 4) {
      const double theta = std::numbers::pi * share(bytes[1]), phi = std::numbers::pi * (2 * share(bytes[2]) - 1);
      const double length = std::exp2(kOctaves * share(bytes[3]) - 1);
      p[l] = kMaxAmplitude * (2 * share(bytes[0]) - 1);
      p[l + 1] = length * std::sin(theta) * std::cos(phi);
      p[l + 2] = length * std::sin(theta) * std::sin(phi);
      p[l + 3] = length * std::cos(theta);
    }
    return p;
  }
};

class OfLobes : public OcclusionCandidate {
 public:
  OfLobes(const std::vector<Vec3>& views, const std::vector<Parameters>& texels, int lobes)
      : views_(views), stride_(static_cast<size_t>(1 + 5 * lobes)) {
    for (const Parameters& p : texels) {
      number_.push_back(static_cast<float>(p[0]));
      for (Eigen::Index l = 1; l < p.size(); l += 4) {
        for (int k = 0; k < 4; ++k) number_.push_back(static_cast<float>(p[l + k]));
        number_.push_back(static_cast<float>(p.segment<3>(l + 1).norm()));
      }
    }
  }

  bool covered(size_t texel, uint32_t view) const override { return covered(texel, views_[view]); }
  bool covered(size_t texel, const Vec3& wv) const override {
    const float* const p = number_.data() + texel * stride_;
    float sum = p[0];
    for (size_t l = 1; l < stride_; l += 5) {
      sum += p[l] * std::exp(p[l + 1] * wv.x + p[l + 2] * wv.y + p[l + 3] * wv.z - p[l + 4]);
    }
    return sum > 0;
  }

 private:
  const std::vector<Vec3> views_;
  const size_t stride_;
  std::vector<float> number_;
};

}  // namespace

std::unique_ptr<OcclusionCandidate> texel_lobes(const LevelTable& table, int lobes) {
  const Dictionary d = dictionary(table.views);
  std::vector<Parameters> found(table.texels());
  tbb::parallel_for(size_t{0}, (found.size() + kBlock - 1) / kBlock, [&](size_t block) {
    for (size_t t = block * kBlock; t < std::min(found.size(), (block + 1) * kBlock); ++t) {
      const Problem problem{table.views, table.level.data() + t * table.views.size()};
      Parameters p = Parameters::Zero(1);
      for (int l = 0; l < lobes; ++l) p = extended(problem, d, p);
      found[t] = descend(problem, p, [] {});
    }
  });
  const LobeBytes bytes;
  std::vector<uint8_t> stored;
  for (const Parameters& p : found) bytes.append(p, stored);
  const size_t each = stored.size() / found.size();
  for (size_t t = 0; t < found.size(); ++t) found[t] = bytes.parameters(stored.data() + t * each, lobes);
  auto candidate = std::make_unique<OfLobes>(table.views, found, lobes);
  candidate->stored = std::move(stored);
  return candidate;
}

}  // namespace velour
