#include "compress/lobe_pursuit.h"

#include "job/parallel.h"

namespace velour {
namespace {

constexpr float kDependent = 1e-3f;  // a column whose part beyond the chosen ones is smaller adds nothing

/// A point on its way: an orthonormal basis of the chosen columns.
struct Span {
  Eigen::MatrixXf basis;
  Eigen::VectorXf norm_sq;  // of the candidates

  Span(const PursuitPoint& point, size_t count)
      : basis(point.column.rows(), static_cast<Eigen::Index>(count)),
        norm_sq(point.column.colwise().squaredNorm().transpose()) {}

  void extend(PursuitPoint& point, Eigen::Index step, Eigen::Index candidate) {
    Eigen::VectorXf column = point.column.col(candidate);
    const float norm = column.norm();
    const auto before = basis.leftCols(step);
    for (int twice = 0; twice < 2; ++twice) column -= before * (before.transpose() * column).eval();
    const float rest = column.norm();
    if (rest > kDependent * norm) {
      column /= rest;
      point.value -= column * column.dot(point.value);
    } else {
      column.setZero();
    }
    basis.col(step) = column;
  }
};

double energy(const std::vector<PursuitPoint>& points) {
  double sum = 0;
  for (const PursuitPoint& p : points) sum += static_cast<double>(p.value.squaredNorm());
  return sum;
}

}  // namespace

PursuitChoice pursue(std::vector<PursuitPoint>& points, size_t count, int threads, const Progress& progress) {
  PursuitChoice choice;
  choice.all = energy(points);
  if (points.empty()) return choice;
  const Eigen::Index candidates = points[0].column.cols();
  std::vector<Span> spans;
  for (const PursuitPoint& p : points) spans.emplace_back(p, count);
  std::vector<Eigen::VectorXf> gain(points.size());
  Eigen::VectorXf open = Eigen::VectorXf::Ones(candidates);
  while (choice.order.size() < count) {
    parallel_pieces(points.size(), threads, progress, [&](size_t i) {
      const Eigen::VectorXf product = points[i].column.transpose() * points[i].value;
      // Columns that are all but zero explain nothing, and rounding must not make them.
      const float least = 1e-6f * static_cast<float>(points[i].value.size());
      gain[i] = product.array().square() / (spans[i].norm_sq.array() + least);
    });
    Eigen::VectorXf total = Eigen::VectorXf::Zero(candidates);
    for (const Eigen::VectorXf& g : gain) total += g;
    Eigen::Index best = 0;
    if (!(total.cwiseProduct(open).maxCoeff(&best) > 0)) break;
    open[best] = 0;
    const auto step = static_cast<Eigen::Index>(choice.order.size());
    parallel_pieces(points.size(), threads, progress, [&](size_t i) { spans[i].extend(points[i], step, best); });
    choice.order.push_back(static_cast<size_t>(best));
    choice.left.push_back(energy(points));
  }
  return choice;
}

}  // namespace velour
