#pragma once
// Eigenvalues by Eigen. Its solver takes long to compile, so it is compiled once, in eigenvalues.cpp.
#include "tests/support/prelude.h"

#include <Eigen/Core>

namespace oracle {

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd &matrix);

} // namespace oracle
