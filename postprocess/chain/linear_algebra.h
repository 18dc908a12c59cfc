// Eigenvalues and solutions of small systems, compiled once: the compiler takes seconds for each size of
// matrix for which Eigen's solvers are called.
#pragma once

#include <Eigen/Core>

namespace drumlin::post {

/// The eigenvalues of a square matrix in no particular order; all NaN if the matrix has an infinite or NaN
/// element.
Eigen::VectorXcd eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd> &matrix);

/// The solution x of A x = b for a square matrix A, by LU decomposition with full pivoting.
Eigen::VectorXd solution_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                            const Eigen::Ref<const Eigen::VectorXd> &b);

} // namespace drumlin::post
