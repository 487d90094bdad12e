#pragma once

#include <Eigen/Core>

namespace sidestep::planner {

/// Residuals and their Jacobian in fewer rows. The first `num_rows` rows of `rows` are (J, r), with
/// r in the last of its m columns. They give way to as many as are returned, at most m, whose
/// (R, s) have R^T R = J^T J, R^T s = J^T r and |s| = |r|: all that a least-squares solver makes
/// use of. Source: Golub & Van Loan, Matrix Computations, 4th ed., section 5.2 (Householder QR).
Eigen::Index CondenseRows(Eigen::MatrixXd& rows, Eigen::Index num_rows);

}  // namespace sidestep::planner
