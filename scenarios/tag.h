#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"

namespace sidestep {
class YamlReader;
}

namespace sidestep::scenarios {

/// A printed AprilTag of the family tag36h11 in the middle of one face of a box, upright.
struct Tag {
  std::string face;   ///< of kBoxFaces
  int id = 0;         ///< from 0 to kNumTagIds - 1
  double size_m = 0;  ///< the edge of its black square
};

inline constexpr const char* kBoxFaces[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
/// How many tags of the family are known here: its first ones.
inline constexpr int kNumTagIds = 64;
/// A tag is a square of so many modules: a white rim of one, a black one, and 6 x 6 of data.
inline constexpr int kTagModules = 10;
/// The edge of the whole print, with its white rim, to that of the black square.
inline constexpr double kTagPrint = 1.25;

/// It stands out from its face by so much, the thickness of paper.
inline constexpr double kTagPaper_m = 1e-4;

/// The pose X_OT of a tag on a box, in the plane of its ink: x to the right of the print, y down, z
/// into the box. Up is +z of the box or, on the faces of z, its +x.
Pose TagPose(const Eigen::Vector3d& box_size_m, const std::string& face);

/// Which modules of a tag are black, row by row from the upper left.
/// @throws std::invalid_argument for an id that is not known.
/// Source: the codes are those of AprilRobotics/apriltag 3.3.0 (see NOTICE).
std::array<bool, kTagModules * kTagModules> BlackModules(int id);

/// Reads the list `tags` of a box, if it is there. @throws InputError.
std::vector<Tag> ReadTags(const YamlReader& box, const Eigen::Vector3d& box_size_m);

/// What ReadTags reads back, as one line; "[]" for none.
std::string ToYaml(const std::vector<Tag>& tags);

}  // namespace sidestep::scenarios
