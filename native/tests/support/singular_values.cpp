#include "support/singular_values.h"

#include <Eigen/SVD>

namespace velour::test {

Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
}

}  // namespace velour::test
