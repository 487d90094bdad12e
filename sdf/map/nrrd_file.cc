#include "sidestep/sdf/map/nrrd_file.h"

#include <cstddef>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/number_text.h"

namespace sidestep::sdf {
namespace {

std::string Vector(const Eigen::Vector3d& v) {
  return "(" + ShortestText(v.x()) + "," + ShortestText(v.y()) + "," + ShortestText(v.z()) + ")";
}

void Write(const GridSpec& spec, const std::string& type, const void* values, std::size_t bytes,
           const std::string& path) {
  const Eigen::Matrix3d axes = spec.cell_m * Eigen::Matrix3d::Identity();
  std::string head = "NRRD0004\ntype: " + type + "\ndimension: 3\nspace dimension: 3\nsizes:";
  for (const int size : spec.size) head += " " + std::to_string(size);
  head += "\nspace directions:";
  for (int axis = 0; axis < 3; ++axis) head += " " + Vector(axes.col(axis));
  head += "\nspace origin: " + Vector(spec.first_center_m) +
          "\nspace units: \"m\" \"m\" \"m\"\nkinds: domain domain domain\nendian: little\n"
          "encoding: raw\n\n";
  AtomicFile file(path);
  file.Append(head);
  file.Append({static_cast<const char*>(values), bytes});
  file.Commit();
}

}  // namespace

void WriteNrrd(const SdfGrid& field, const std::string& path) {
  Write(field.spec(), "float", field.distance_m().data(), field.distance_m().size() * sizeof(float),
        path);
}

void WriteNrrd(const OccupancyGrid& occupancy, const std::string& path) {
  Write(occupancy.spec, "uint8", occupancy.cells.data(), occupancy.cells.size(), path);
}

}  // namespace sidestep::sdf
