// By itself, since it takes as long to compile as all other functions of linear algebra.
#include "chain/linear_algebra.h"

#include <Eigen/Eigenvalues>

#include <limits>

namespace drumlin::post {

Eigen::VectorXcd eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd> &matrix) {
  if (!matrix.allFinite())
    return Eigen::VectorXcd::Constant(matrix.rows(), std::numeric_limits<double>::quiet_NaN());
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
}

} // namespace drumlin::post
