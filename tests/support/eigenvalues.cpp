#include "tests/support/eigenvalues.h"

#include <Eigen/Eigenvalues>

Eigen::VectorXcd oracle::eigenvalues_of(const Eigen::MatrixXd &matrix) { return matrix.eigenvalues(); }
