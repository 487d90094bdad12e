#include "sidestep/sdf/map/nrrd_file.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <fstream>

#include "sidestep/core/input_error.h"

namespace sidestep::sdf {
namespace {

std::string Number(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string Vector(const Eigen::Vector3d& v) {
  return "(" + Number(v.x()) + "," + Number(v.y()) + "," + Number(v.z()) + ")";
}

void Write(const GridSpec& spec, const std::string& type, const void* values, std::size_t bytes,
           const std::string& path) {
  const Eigen::Matrix3d axes = spec.cell_m * Eigen::Matrix3d::Identity();
  std::ofstream file(path, std::ios::binary);
  file << "NRRD0004\ntype: " << type
       << "\ndimension: 3\nspace dimension: 3\nsizes: " << spec.size[0] << ' ' << spec.size[1]
       << ' ' << spec.size[2] << "\nspace directions: " << Vector(axes.col(0)) << ' '
       << Vector(axes.col(1)) << ' ' << Vector(axes.col(2))
       << "\nspace origin: " << Vector(spec.first_center_m)
       << "\nspace units: \"m\" \"m\" \"m\"\nkinds: domain domain domain\nendian: little\n"
          "encoding: raw\n\n";
  file.write(static_cast<const char*>(values), static_cast<std::streamsize>(bytes));
  file.close();
  if (!file) throw InputError(path, "cannot be written");
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
