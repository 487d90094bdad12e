#include "sidestep/planner/costs/condense_rows.h"

#include <Eigen/QR>

namespace sidestep::planner {

Eigen::Index CondenseRows(Eigen::MatrixXd& rows, Eigen::Index num_rows) {
  if (num_rows <= rows.cols()) return num_rows;
  Eigen::Ref<Eigen::MatrixXd> top = rows.topRows(num_rows);
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> decompose(top);  // in place
  top.triangularView<Eigen::StrictlyLower>().setZero();
  return rows.cols();
}

}  // namespace sidestep::planner
