#pragma once

#include <string>
#include <vector>

namespace sidestep::imports {

/// The file that a mesh's `filename` in a URDF means.
/// - `package://NAME/REST` (`model://` too): REST in the folder NAME of one of `package_paths`, or
///   in one of them that is called NAME itself; else in a folder called NAME beside the URDF or
///   above it, the nearest first.
/// - `file:///PATH`: with %20 and the like written out. Anything else: beside the URDF.
/// @throws InputError, without a place, that says where was looked; for http and the like.
std::string ResolveMeshUri(const std::string& uri, const std::string& urdf_path,
                           const std::vector<std::string>& package_paths);

}  // namespace sidestep::imports
