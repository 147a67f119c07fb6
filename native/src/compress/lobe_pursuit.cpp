#include "compress/lobe_pursuit.h"

#include <algorithm>

#include "job/parallel.h"

namespace velour {
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
