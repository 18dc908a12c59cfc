// Eigenvalues and solutions of small systems, compiled once: the compiler takes seconds for each size of
// matrix for which Eigen's solvers are called.
#pragma once

#include <Eigen/Core>

namespace drumlin::post {

/// Eigenvalues of a square matrix, unsorted; all NaN if an element is not finite.
Eigen::VectorXcd eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd> &matrix);

/// x of A x = b for a square A, by elimination with full pivoting.
Eigen::VectorXd solution_of(const Eigen::Ref<const Eigen::MatrixXd> &A,
                            const Eigen::Ref<const Eigen::VectorXd> &b);

} // namespace drumlin::post
