#include "chain/linear_algebra.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <limits>

namespace drumlin::post {

Eigen::VectorXd solution_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                            const Eigen::Ref<const Eigen::VectorXd> &b) {
  return Eigen::FullPivLU<Eigen::MatrixXd>(A).solve(b);
}

double last_pivot_of(const Eigen::Ref<const Eigen::MatrixXd> &A) {
  return Eigen::FullPivLU<Eigen::MatrixXd>(A).matrixLU()(A.rows() - 1, A.cols() - 1);
}

Eigen::MatrixXd product_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                           const Eigen::Ref<const Eigen::MatrixXd> &B) {
  return A * B;
}

PseudoInverse pseudo_inverse_of(const Eigen::Ref<const Eigen::MatrixXd> &A) {
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(A);
  return {factors.pseudoInverse(), factors.rank()};
}

LeastSquares::LeastSquares(const Eigen::Ref<const Eigen::MatrixXd> &A) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
  q_ = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), A.cols());
  r_ = qr.matrixQR().topRows(A.cols());
}

Eigen::VectorXd LeastSquares::solution(const Eigen::Ref<const Eigen::VectorXd> &b) const {
  Eigen::VectorXd x = q_.transpose() * b;
  for (Eigen::Index i = x.size() - 1; i >= 0; --i) {
    for (Eigen::Index j = i + 1; j < x.size(); ++j)
      x[i] -= r_(i, j) * x[j];
    x[i] /= r_(i, i);
  }
  return x;
}

Eigen::MatrixXd LeastSquares::left_of(const Eigen::Ref<const Eigen::MatrixXd> &columns) const {
  return columns - q_ * (q_.transpose() * columns);
}

SymmetricSystem::SymmetricSystem(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
    : sizes_(matrix.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse()),
      scaled_(sizes_.asDiagonal() * matrix * sizes_.asDiagonal()) {}

Eigen::MatrixXd SymmetricSystem::solutions(const Eigen::Ref<const Eigen::MatrixXd> &right) const {
  return sizes_.asDiagonal() * scaled_.solve(sizes_.asDiagonal() * right);
}

Eigen::VectorXd SymmetricSystem::solution(const Eigen::Ref<const Eigen::VectorXd> &right) const {
  return solutions(right);
}

Eigen::MatrixXd SymmetricSystem::inverse() const {
  return solutions(Eigen::MatrixXd::Identity(sizes_.size(), sizes_.size()));
}

double SymmetricSystem::least_pivot() const { return scaled_.vectorD().minCoeff(); }

Eigen::MatrixXd SymmetricSystem::eliminate(const Eigen::Ref<const Eigen::MatrixXd> &mixed,
                                           const Eigen::Ref<const Eigen::VectorXd> &own,
                                           Eigen::MatrixXd &matrix, Eigen::VectorXd &right) const {
  Eigen::MatrixXd share = solutions(mixed);
  matrix -= mixed.transpose() * share;
  right -= share.transpose() * own;
  return share;
}

} // namespace drumlin::post
