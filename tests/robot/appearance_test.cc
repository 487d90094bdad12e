#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>
#include <string>

#include "tests/robot/geom_surface.h"

namespace sidestep::robot {
namespace {

// Contact and occupancy use the box of the published experiments, 0.55 m along the way it drives
// (the picture's x), 0.48 m across and 1.2 m high. What is seen must agree with it.
TEST(HsrPicture, StaysInsideTheBoxThatIsJudgedAndFillsItsHeight) {
  char error[1000] = "";
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
      mj_loadXML(SIDESTEP_SOURCE_DIR "/models/hsr/hsr.xml", nullptr, error, sizeof error),
      mj_deleteModel);
  ASSERT_NE(model, nullptr) << error;
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
  mj_kinematics(model.get(), data.get());
  Eigen::Vector3d lowest = Eigen::Vector3d::Constant(10), highest = -lowest;
  for (int geom = 0; geom < model->ngeom; ++geom) {
    EXPECT_EQ(model->geom_contype[geom], 0);
    EXPECT_EQ(model->geom_conaffinity[geom], 0);
    EXPECT_EQ(model->geom_group[geom], 2);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data->geom_xmat +
                                                                           9 * geom);
    const Eigen::Map<const Eigen::Vector3d> p(data->geom_xpos + 3 * geom);
    const Eigen::Matrix3Xd surface =
        (R * SampleSurface(ShapeOf(*model, geom))).colwise() + Eigen::Vector3d(p);
    lowest = lowest.cwiseMin(surface.rowwise().minCoeff());
    highest = highest.cwiseMax(surface.rowwise().maxCoeff());
  }
  const double rounding_m = 1e-12;
  const Eigen::Array3d box_lowest(-0.275, -0.24, 0), box_highest(0.275, 0.24, 1.2);
  EXPECT_TRUE((lowest.array() >= box_lowest - rounding_m).all()) << lowest.transpose();
  EXPECT_TRUE((highest.array() <= box_highest + rounding_m).all()) << highest.transpose();
  EXPECT_GE(highest.z(), 1.1) << "the box would be much taller than what is seen";
}

}  // namespace
}  // namespace sidestep::robot
