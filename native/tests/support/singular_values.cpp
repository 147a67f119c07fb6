#include "support/singular_values.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace velour::test {

namespace {

double product(const Eigen::MatrixXd& m, Eigen::Index i, Eigen::Index j) {
  double sum = 0;
  for (Eigen::Index row = 0; row < m.rows(); ++row) sum += m(row, i) * m(row, j);
  return sum;
}

/// Rotates two columns until they are orthogonal. Returns whether they were not.
bool rotate(Eigen::MatrixXd& m, Eigen::Index i, Eigen::Index j) {
  const double mixed = product(m, i, j), first = product(m, i, i), second = product(m, j, j);
  if (std::abs(mixed) <= std::numeric_limits<double>::epsilon() * std::sqrt(first * second)) return false;
  const double ratio = (second - first) / (2 * mixed);
  const double tangent = std::copysign(1 / (std::abs(ratio) + std::hypot(1.0, ratio)), ratio);
  const double cosine = 1 / std::hypot(1.0, tangent), sine = tangent * cosine;
  for (Eigen::Index row = 0; row < m.rows(); ++row) {
    const double a = m(row, i), b = m(row, j);
    m(row, i) = cosine * a - sine * b;
    m(row, j) = sine * a + cosine * b;
  }
  return true;
}

}  // namespace

Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix) {
  constexpr int kMaxSweeps = 40;
  Eigen::MatrixXd m = matrix;
  if (m.cols() > m.rows()) m = matrix.transpose();
  bool turned = true;
  for (int sweep = 0; turned && sweep < kMaxSweeps; ++sweep) {
    turned = false;
    for (Eigen::Index i = 0; i < m.cols(); ++i) {
      for (Eigen::Index j = i + 1; j < m.cols(); ++j) turned |= rotate(m, i, j);
    }
  }
  Eigen::VectorXd values(m.cols());
  for (Eigen::Index i = 0; i < m.cols(); ++i) values[i] = std::sqrt(product(m, i, i));
  std::sort(values.data(), values.data() + values.size(), std::greater<>());
  return values;
}

}  // namespace velour::test
