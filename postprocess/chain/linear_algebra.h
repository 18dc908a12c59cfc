// Eigenvalues and solutions of small systems, compiled once: the compiler takes seconds for each size of
// matrix for which Eigen's solvers are called.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace drumlin::post {

/// The eigenvalues of a square matrix in no particular order; all NaN if the matrix has an infinite or NaN
/// element.
Eigen::VectorXcd eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd> &matrix);

/// The solution x of A x = b for a square matrix A, by LU decomposition with full pivoting.
Eigen::VectorXd solution_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                            const Eigen::Ref<const Eigen::VectorXd> &b);

/// The last pivot of the same decomposition: 0 if the matrix is singular.
double last_pivot_of(const Eigen::Ref<const Eigen::MatrixXd> &A);

/// A B.
Eigen::MatrixXd product_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                           const Eigen::Ref<const Eigen::MatrixXd> &B);

/// The pseudo-inverse of Moore and Penrose, and the rank, of any matrix.
struct PseudoInverse {
  Eigen::MatrixXd matrix;
  Eigen::Index rank = 0;
};
PseudoInverse pseudo_inverse_of(const Eigen::Ref<const Eigen::MatrixXd> &A);

/// A problem of linear least squares with at least as many rows as unknowns, by Householder's QR.
class LeastSquares {
public:
  explicit LeastSquares(const Eigen::Ref<const Eigen::MatrixXd> &A);
  Eigen::VectorXd solution(const Eigen::Ref<const Eigen::VectorXd> &b) const;
  /// What the solutions leave of columns.
  Eigen::MatrixXd left_of(const Eigen::Ref<const Eigen::MatrixXd> &columns) const;
  /// Share of each row that the solution takes.
  Eigen::VectorXd levers() const { return q_.rowwise().squaredNorm(); }

private:
  Eigen::MatrixXd q_, r_;
};

/// A symmetric system of linear equations, by L D L^T with pivots of the matrix with a diagonal of ones.
class SymmetricSystem {
public:
  explicit SymmetricSystem(const Eigen::Ref<const Eigen::MatrixXd> &matrix);
  Eigen::VectorXd solution(const Eigen::Ref<const Eigen::VectorXd> &right) const;
  Eigen::MatrixXd inverse() const;
  /// 0 or below: the matrix is not positive definite.
  double least_pivot() const;
  /// Takes the unknowns of this system out of a larger one (Schur complement). \param mixed a row for each
  /// unknown of this system, a column for each that stays \param own the right side of this system
  /// \param matrix, right of those that stay. Returns this system's solutions for `mixed`.
  Eigen::MatrixXd eliminate(const Eigen::Ref<const Eigen::MatrixXd> &mixed,
                            const Eigen::Ref<const Eigen::VectorXd> &own, Eigen::MatrixXd &matrix,
                            Eigen::VectorXd &right) const;

private:
  Eigen::MatrixXd solutions(const Eigen::Ref<const Eigen::MatrixXd> &right) const;

  Eigen::VectorXd sizes_; // of the unknowns
  Eigen::LDLT<Eigen::MatrixXd> scaled_;
};

} // namespace drumlin::post
