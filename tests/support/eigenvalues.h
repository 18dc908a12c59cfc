#pragma once
/// Eigen's solver for eigenvalues, which takes long to compile, in a source of its own.

#include <Eigen/Core>

namespace oracle {

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd &matrix);

} // namespace oracle
