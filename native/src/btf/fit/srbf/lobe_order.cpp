#include "btf/fit/srbf/lobe_order.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

#include "base/memory.h"
#include "base/parallel.h"
#include "btf/model/srbf_btf.h"
#include "math/optimize/lbfgs.h"
#include "math/sphere/random.h"
#include "math/tensor/matrix_product.h"

namespace velour {

namespace {

/// The numbers of lobes as parameters of a descent, each argument in units of its initial length, so that broad and
/// narrow lobes move alike.
class LobeVectors {
 public:
  explicit LobeVectors(std::vector<MultivariateLobe> lobes) : lobes_(std::move(lobes)) {
    for (MultivariateLobe& lobe : lobes_) {
      for (int a = 0; a < MultivariateLobe::kArguments; ++a) {
        // A zero vector has no slope.
        const int last = std::min(3 * a + 2, MultivariateLobe::kNumbers - 1);
        if (lobe.length(a) == 0) lobe[last] = kBroadest;
        for (int i = 3 * a; i <= last; ++i) unit_.push_back(1 + static_cast<double>(lobe.length(a)));
      }
    }
  }

  Eigen::VectorXd start() {
    Eigen::VectorXd x(static_cast<Eigen::Index>(unit_.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = static_cast<double>(component(lobes_, i)) / unit(i);
    return x;
  }
  std::vector<MultivariateLobe> at(const Eigen::VectorXd& x) const {
    std::vector<MultivariateLobe> lobes = lobes_;
    for (Eigen::Index i = 0; i < x.size(); ++i) component(lobes, i) = static_cast<float>(x[i] * unit(i));
    return lobes;
  }
  Eigen::VectorXd slope(const Eigen::MatrixXd& by_vector) const {
    Eigen::VectorXd slope = Eigen::Map<const Eigen::VectorXd>(by_vector.data(), by_vector.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) slope[i] *= unit(i);
    return slope;
  }

 private:
  static constexpr float kBroadest = 0.05f;
  double unit(Eigen::Index i) const { return unit_[static_cast<size_t>(i)]; }
  static float& component(std::vector<MultivariateLobe>& lobes, Eigen::Index i) {
    const auto number = static_cast<int>(i);
    return lobes[static_cast<size_t>(number / MultivariateLobe::kNumbers)][number % MultivariateLobe::kNumbers];
  }

  std::vector<MultivariateLobe> lobes_;
  std::vector<double> unit_;  // per number
};

}  // namespace

std::vector<MultivariateLobe> refine_lobes(const std::vector<SurfacePoint>& points, std::vector<MultivariateLobe> lobes,
                                           const RefinementOptions& options, Progress& progress) {
  const ProjectedError error(points, options.tile_lobes, options.threads, progress);
  LobeVectors vectors(std::move(lobes));
  Eigen::MatrixXd by_vector;
  const auto f = [&](const Eigen::VectorXd& x, Eigen::VectorXd& slope) {
    const double value = error(vectors.at(x), by_vector);
    slope = vectors.slope(by_vector);
    return value;
  };
  LbfgsOptions descent;
  descent.steps = options.steps;
  const auto after_step = [&](int step) { progress.update(static_cast<double>(step + 1) / options.steps); };
  return vectors.at(descend_lbfgs(f, vectors.start(), descent, after_step));
}

namespace {

constexpr float kTileRidge = 1e-5f;  // on coefficients, relative to a lobe of value 1 everywhere

/// Solves gram x = moment. `gram` (symmetric; its lower half is read) may be singular up to rounding.
Eigen::VectorXf solved(const Eigen::MatrixXf& gram, const Eigen::VectorXf& moment) {
  const Eigen::LLT<Eigen::MatrixXf> factor(gram);  // in blocks: several times as fast as LDLT
  if (factor.info() == Eigen::Success) return factor.solve(moment);
  return gram.selfadjointView<Eigen::Lower>().ldlt().solve(moment);
}

}  // namespace

struct ProjectedError::Part {
  double error = 0;
  Eigen::MatrixXf slope;  // number x lobe
};

ProjectedError::ProjectedError(const std::vector<SurfacePoint>& points, uint32_t tile_lobes, int threads,
                               const Progress& progress)
    : points_(points), tile_lobes_(tile_lobes), threads_(threads), progress_(progress) {
  for (const SurfacePoint& point : points) {
    auto& of_point = argument_.emplace_back();
    for (size_t frame = 0; frame < 2; ++frame) {
      of_point[frame].resize(MultivariateLobe::kNumbers, static_cast<Eigen::Index>(point.pair.size()));
      for (size_t i = 0; i < point.pair.size(); ++i) {
        const LobeArguments at = frame == 0 ? point.pair[i] : point.pair[i].turned(point.to_normal);
        for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
          of_point[frame](k, static_cast<Eigen::Index>(i)) = at[k];
        }
      }
    }
  }
}

double ProjectedError::operator()(const std::vector<MultivariateLobe>& lobes, Eigen::MatrixXd& slope) const {
  const LobeValues values(lobes, tile_lobes_);
  std::vector<Part> part(points_.size());
  parallel_pieces(points_.size(), threads_, progress_, [&](size_t i) { part[i] = of_point(i, lobes, values); });
  slope.setZero(MultivariateLobe::kNumbers, static_cast<Eigen::Index>(lobes.size()));
  double error = 0;
  for (const Part& p : part) {  // in order: the same bits for any number of threads
    error += p.error;
    slope += p.slope.cast<double>();
  }
  return error;
}

ProjectedError::Part ProjectedError::of_point(size_t number, const std::vector<MultivariateLobe>& lobes,
                                              const LobeValues& values) const {
  const SurfacePoint& point = points_[number];
  const auto count = static_cast<Eigen::Index>(lobes.size());
  Part part{0, Eigen::MatrixXf::Zero(MultivariateLobe::kNumbers, count)};
  if (point.pair.empty()) return part;
  const Eigen::MatrixXf column = values.at(point, point.pair.size());
  const Eigen::Map<const Eigen::VectorXf> truth(point.value[0].data(), column.rows());
  const float ridge = kTileRidge * static_cast<float>(column.rows());
  Eigen::MatrixXf gram(count, count);
  multiply_by_itself({column.data(), count, column.rows(), column.rows(), 1}, {gram.data(), count, count, 1, count});
  gram.diagonal().array() += ridge;
  const Eigen::VectorXf coefficient = solved(gram, column.transpose() * truth);
  const Eigen::VectorXf rest = truth - column * coefficient;
  part.error = static_cast<double>(rest.squaredNorm() + ridge * coefficient.squaredNorm());
  // At the best coefficients the error does not change with them: only the change of the lobes remains.
  const Eigen::MatrixXf weight = (column.array().colwise() * rest.array()).matrix();
  const auto tile = static_cast<Eigen::Index>(tile_lobes_);
  part.slope.leftCols(tile) = argument_[number][0] * weight.leftCols(tile);
  part.slope.rightCols(count - tile) = argument_[number][1] * weight.rightCols(count - tile);
  for (Eigen::Index j = 0; j < count; ++j) {
    const float total = weight.col(j).sum();
    const MultivariateLobe& lobe = lobes[static_cast<size_t>(j)];
    for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
      const float length = lobe.length(k / 3);
      if (length > 0) part.slope(k, j) -= total * lobe[k] / length;
    }
    part.slope.col(j) *= -2 * coefficient[j];
  }
  return part;
}

RowMatrix LobeValues::at(const SurfacePoint& point, size_t pairs) const {
  const size_t count = std::min(pairs, point.pair.size());
  RowMatrix values(static_cast<Eigen::Index>(count), tile_.size() + texel_.size());
  AlignedArray<float> row(std::max(tile_.padded(), texel_.padded()));
  for (size_t i = 0; i < count; ++i) {
    float* const to = values.row(static_cast<Eigen::Index>(i)).data();
    tile_.values(point.pair[i], row.data());
    std::copy_n(row.data(), tile_.size(), to);
    texel_.values(point.pair[i].turned(point.to_normal), row.data());
    std::copy_n(row.data(), texel_.size(), to + tile_.size());
  }
  return values;
}

namespace {

/// Log-uniform.
float random_bandwidth(RandomStream& random, float narrowest, float widest) {
  return narrowest * std::pow(widest / narrowest, random.next());
}

/// A direction, uniform by area with z in [least_z, 1], times a random bandwidth.
Vec3 random_vector(RandomStream& random, float least_z, float narrowest, float widest) {
  const float z = std::lerp(least_z, 1.0f, random.next()), phi = 2 * kPi * random.next(), s = std::sqrt(1 - z * z);
  return Vec3(s * std::cos(phi), s * std::sin(phi), z) * random_bandwidth(random, narrowest, widest);
}

MultivariateLobe random_lobe(RandomStream& random, bool texel) {
  MultivariateLobe lobe;
  const int kind = static_cast<int>(random.next() * 9);
  // Highlights of texels are close to their normals.
  const float half_z = texel ? 0.97f : 0.2f;
  if (kind < 3) {
    lobe.light = random_vector(random, 0, 0.7f, 60);
  } else if (kind < 5) {
    lobe.light = random_vector(random, 0, 0.7f, 40);
    lobe.view = random_vector(random, 0.1f, 0.5f, 20);
  } else if (kind == 5) {
    lobe.half = random_vector(random, half_z, 2, 400);
  } else if (kind == 6) {
    lobe.half = random_vector(random, half_z, 4, 400);
    lobe.light = random_vector(random, 0, 0.7f, 20);
  } else if (kind == 7) {
    lobe.phase = random_bandwidth(random, 0.7f, 15);
    if (random.next() < 0.5f) lobe.light = random_vector(random, 0, 0.7f, 20);
  } else {
    lobe.view = random_vector(random, 0.1f, 0.5f, 20);
  }
  return lobe;
}

/// The pursuits of the three axes, which share their columns.
class OrderSearch {
 public:
  OrderSearch(const std::vector<RowMatrix>& columns, const std::vector<SurfacePoint>& points, int threads) {
    size_t pairs = 0;
    for (const SurfacePoint& point : points) pairs = std::max(pairs, point.pair.size());
    most_of_axis_ = std::min<size_t>(SrbfBtf::kMaxLobes, pairs);
    for (size_t a = 0; a < 3; ++a) {
      pursuit_.emplace_back(columns, point_values(points, columns, a), threads);
      all_ += pursuit_[a].choice().all;
    }
    rest_ = all_;
  }

  /// Adds a coefficient; false if nothing is left to explain.
  bool step(const Progress& progress) {
    double most = -1;
    size_t to = 3;
    for (size_t a = 0; a < 3; ++a) {
      if (!looks_ahead(a, progress)) continue;
      const double gain = left(a, share_[a]) - left(a, share_[a] + 1);
      if (gain > most) {
        most = gain;
        to = a;
      }
    }
    if (to == 3) return false;
    ++share_[to];
    rest_ -= most;
    order_.axis.push_back(static_cast<uint8_t>(to));
    order_.left.push_back(std::max(0.0, rest_ / all_));
    return true;
  }

  double left() const { return order_.left.empty() ? 1.0 : order_.left.back(); }

  LobeOrder take() {
    for (size_t a = 0; a < 3; ++a) {
      const std::vector<size_t>& all = pursuit_[a].choice().order;
      order_.candidate[a].assign(all.begin(), all.begin() + static_cast<ptrdiff_t>(share_[a]));
    }
    if (share_[0] == 0) need_one();
    return std::move(order_);
  }

 private:
  double left(size_t a, size_t n) const { return n == 0 ? pursuit_[a].choice().all : pursuit_[a].choice().left[n - 1]; }
  bool looks_ahead(size_t a, const Progress& progress) {
    return pursuit_[a].choice().order.size() > share_[a] || (share_[a] < most_of_axis_ && pursuit_[a].step(progress));
  }
  /// A model needs at least one lobe.
  void need_one() {
    order_.candidate[0] = {0};
    order_.axis.insert(order_.axis.begin(), 0);
    order_.left.insert(order_.left.begin(), all_ > 0 ? 1.0 : 0.0);
  }

  std::vector<Pursuit> pursuit_;
  size_t most_of_axis_ = 0;  // more lobes than pairs would cancel each other
  std::array<size_t, 3> share_{};
  double all_ = 0, rest_ = 0;
  LobeOrder order_;
};

}  // namespace

LobeCandidates random_candidates(uint64_t seed) {
  LobeCandidates candidates{{MultivariateLobe{}}, kLobeCandidates / 2};
  for (uint32_t i = 1; i < kLobeCandidates; ++i) {
    RandomStream random(seed, i, 2);
    candidates.lobes.push_back(random_lobe(random, i >= candidates.tile_lobes));
  }
  return candidates;
}

std::vector<RowMatrix> candidate_columns(const std::vector<SurfacePoint>& points, const LobeCandidates& candidates,
                                         size_t most_points, size_t most_pairs, int threads, const Progress& progress) {
  const LobeValues values(candidates.lobes, candidates.tile_lobes);
  std::vector<RowMatrix> columns(std::min(most_points, points.size()));
  parallel_pieces(columns.size(), threads, progress, [&](size_t i) { columns[i] = values.at(points[i], most_pairs); });
  return columns;
}

std::vector<Eigen::VectorXf> point_values(const std::vector<SurfacePoint>& points,
                                          const std::vector<RowMatrix>& columns, size_t axis) {
  std::vector<Eigen::VectorXf> values;
  for (size_t i = 0; i < columns.size(); ++i) {
    values.emplace_back(Eigen::Map<const Eigen::VectorXf>(points[i].value[axis].data(), columns[i].rows()));
  }
  return values;
}

std::array<size_t, 3> LobeOrder::share(size_t count) const {
  std::array<size_t, 3> share{};
  for (size_t i = 0; i < std::min(count, axis.size()); ++i) ++share[axis[i]];
  return share;
}

LobeOrder order_lobes(const std::vector<SurfacePoint>& points, const LobeOrderOptions& options, Progress& progress) {
  const std::vector<RowMatrix> columns = candidate_columns(points, random_candidates(options.seed), options.points,
                                                           kOrderPairs, options.threads, progress);
  OrderSearch search(columns, points, options.threads);
  for (size_t i = 0; i < options.most && search.left() > options.least && search.step(progress); ++i) {
    progress.update(static_cast<double>(i + 1) / static_cast<double>(options.most));
  }
  return search.take();
}

namespace {

constexpr float kDependent = 1e-3f;  // columns whose relative part beyond the chosen ones is smaller add nothing
constexpr Eigen::Index kFirstRoom = 16;

}  // namespace

Pursuit::Pursuit(const std::vector<RowMatrix>& columns, std::vector<Eigen::VectorXf> values, int threads)
    : columns_(columns), rest_(std::move(values)), basis_(columns.size()), threads_(threads) {
  choice_.all = energy();
  for (const RowMatrix& m : columns) norm_sq_.emplace_back(m.colwise().squaredNorm().transpose());
  if (!columns.empty()) open_ = Eigen::VectorXf::Ones(columns[0].cols());
}

double Pursuit::energy() const {
  double sum = 0;
  for (const Eigen::VectorXf& rest : rest_) sum += static_cast<double>(rest.squaredNorm());
  return sum;
}

bool Pursuit::step(const Progress& progress) {
  if (columns_.empty()) return false;
  std::vector<Eigen::VectorXf> gain(columns_.size());
  parallel_pieces(columns_.size(), threads_, progress, [&](size_t i) {
    const Eigen::VectorXf product = columns_[i].transpose() * rest_[i];
    // Near-zero columns must not gain from rounding errors, nor points that no view shows.
    const float least = 1e-6f * static_cast<float>(std::max<Eigen::Index>(1, rest_[i].size()));
    gain[i] = product.array().square() / (norm_sq_[i].array() + least);
  });
  Eigen::VectorXf total = Eigen::VectorXf::Zero(open_.size());
  for (const Eigen::VectorXf& g : gain) total += g;
  Eigen::Index best = 0;
  if (!(total.cwiseProduct(open_).maxCoeff(&best) > 0)) return false;
  open_[best] = 0;
  parallel_pieces(columns_.size(), threads_, progress, [&](size_t i) { extend(i, best); });
  choice_.order.push_back(static_cast<size_t>(best));
  choice_.left.push_back(energy());
  return true;
}

void Pursuit::extend(size_t point, Eigen::Index candidate) {
  const auto step = static_cast<Eigen::Index>(choice_.order.size());
  Eigen::MatrixXf& basis = basis_[point];
  Eigen::VectorXf column = columns_[point].col(candidate);
  if (step >= basis.cols()) basis.conservativeResize(column.size(), std::max(kFirstRoom, 2 * basis.cols()));
  const float norm = column.norm();
  const auto before = basis.leftCols(step);
  for (int twice = 0; twice < 2; ++twice) column -= before * (before.transpose() * column).eval();
  const float rest = column.norm();
  if (rest > kDependent * norm) {
    column /= rest;
    rest_[point] -= column * column.dot(rest_[point]);
  } else {
    column.setZero();
  }
  basis.col(step) = column;
}

PursuitChoice pursue(const std::vector<RowMatrix>& columns, std::vector<Eigen::VectorXf> values, size_t count,
                     int threads, const Progress& progress) {
  Pursuit pursuit(columns, std::move(values), threads);
  while (pursuit.choice().order.size() < count && pursuit.step(progress)) {
  }
  return pursuit.choice();
}

}  // namespace velour
