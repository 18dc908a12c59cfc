#include "chain/linear_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <limits>

namespace drumlin::post {

Eigen::VectorXcd eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd> &matrix) {
  if (!matrix.allFinite())
    return Eigen::VectorXcd::Constant(matrix.rows(), std::numeric_limits<double>::quiet_NaN());
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
}

Eigen::VectorXd solution_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                            const Eigen::Ref<const Eigen::VectorXd> &b) {
  return Eigen::FullPivLU<Eigen::MatrixXd>(A).solve(b);
}

} // namespace drumlin::post
