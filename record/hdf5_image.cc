#include "sidestep/record/hdf5_image.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "sidestep/core/input_error.h"

namespace sidestep::record {
namespace {

std::mutex& LibraryMutex() {
  static std::mutex mutex;
  return mutex;
}

std::size_t NumValues(const std::vector<hsize_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

void RequireDone(bool done, const std::string& what) {
  if (!done) throw std::runtime_error("HDF5 cannot " + what);
}

// The library refuses a null pointer even where there is nothing to read.
bool ReadAll(hid_t dataset, hid_t memory_type, std::size_t num_values, void* values) {
  return num_values == 0 ||
         H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
}

Hdf5Id MakeDataspace(const std::vector<hsize_t>& shape) {
  return shape.empty()
             ? Hdf5Id(H5Screate(H5S_SCALAR))
             : Hdf5Id(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
}

Hdf5Id MakeStringType(std::size_t length) {
  Hdf5Id type(H5Tcopy(H5T_C_S1));
  RequireDone(H5Tset_size(type, std::max<std::size_t>(1, length)) >= 0 &&
                  H5Tset_cset(type, H5T_CSET_UTF8) >= 0 &&
                  H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0,
              "make a text type");
  return type;
}

template <typename T>
void CheckSize(const std::string& path, const Hdf5Array<T>& array) {
  if (NumValues(array.shape) != array.values.size()) {
    throw std::invalid_argument(path + ": the shape does not fit the number of values");
  }
}

std::string ToText(const std::vector<hsize_t>& shape) {
  if (shape.empty()) return "a single value";
  std::string text = "shape ";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) text += " x ";
    text += shape[i] == Hdf5ImageReader::kAny ? "any" : std::to_string(shape[i]);
  }
  return text;
}

}  // namespace

Hdf5Session::Hdf5Session() : lock_(LibraryMutex()) {
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Session::~Hdf5Session() { H5Eset_auto2(H5E_DEFAULT, print_, print_data_); }

Hdf5ImageWriter::Hdf5ImageWriter()
    : file_([] {
        const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE));
        const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS));
        // The earliest format: H5Fget_file_image() spoils the checksum of later superblocks.
        constexpr std::size_t kGrowthBytes = 1 << 20;
        RequireDone(H5Pset_obj_track_times(creation, false) >= 0 &&
                        H5Pset_fapl_core(access, kGrowthBytes, /*backing_store=*/false) >= 0 &&
                        H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18) >= 0,
                    "set up a file");
        return H5Fcreate("in memory", H5F_ACC_TRUNC, creation, access);
      }()) {
  RequireDone(file_.valid(), "create a file in memory");
}

void Hdf5ImageWriter::SetAttribute(hid_t object, const std::string& name, hid_t file_type,
                                   hid_t memory_type, const void* data) {
  const Hdf5Id space(H5Screate(H5S_SCALAR));
  const Hdf5Id attribute(
      H5Acreate2(object, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT));
  RequireDone(attribute.valid() && H5Awrite(attribute, memory_type, data) >= 0,
              "write the attribute " + name);
}

void Hdf5ImageWriter::SetAttribute(const std::string& name, const std::string& value) {
  const Hdf5Id type = MakeStringType(value.size());
  SetAttribute(file_, name, type, type, value.c_str());
}

void Hdf5ImageWriter::SetAttribute(const std::string& name, std::int64_t value) {
  SetAttribute(file_, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void Hdf5ImageWriter::MakeGroup(const std::string& path) {
  const Hdf5Id creation(H5Pcreate(H5P_GROUP_CREATE));
  RequireDone(H5Pset_obj_track_times(creation, false) >= 0, "turn time stamps off");
  const Hdf5Id group(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
  RequireDone(group.valid(), "create the group " + path);
}

void Hdf5ImageWriter::WriteDataset(const std::string& path, hid_t file_type, hid_t memory_type,
                                   const std::vector<hsize_t>& shape, const void* data,
                                   const std::string& unit) {
  constexpr unsigned kDeflateLevel = 4;
  constexpr hsize_t kRowsAChunk = 4096;
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE));
  RequireDone(H5Pset_obj_track_times(creation, false) >= 0, "turn time stamps off");
  const bool has_values = NumValues(shape) > 0;
  if (!shape.empty() && has_values) {
    std::vector<hsize_t> chunk = shape;
    chunk[0] = std::min(chunk[0], kRowsAChunk);
    RequireDone(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()) >= 0 &&
                    H5Pset_shuffle(creation) >= 0 && H5Pset_deflate(creation, kDeflateLevel) >= 0,
                "set up compression");
  }
  const Hdf5Id space = MakeDataspace(shape);
  const Hdf5Id dataset(
      H5Dcreate2(file_, path.c_str(), file_type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  RequireDone(dataset.valid(), "create " + path);
  if (has_values) {
    RequireDone(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
                "write " + path);
  }
  if (!unit.empty()) {
    const Hdf5Id type = MakeStringType(unit.size());
    SetAttribute(dataset, "unit", type, type, unit.c_str());
  }
}

void Hdf5ImageWriter::Write(const std::string& path, const Hdf5Array<double>& array,
                            const std::string& unit) {
  CheckSize(path, array);
  WriteDataset(path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, array.shape, array.values.data(), unit);
}

void Hdf5ImageWriter::Write(const std::string& path, const Hdf5Array<std::int64_t>& array) {
  CheckSize(path, array);
  WriteDataset(path, H5T_STD_I64LE, H5T_NATIVE_INT64, array.shape, array.values.data(), "");
}

void Hdf5ImageWriter::Write(const std::string& path, const Hdf5Array<std::string>& array) {
  CheckSize(path, array);
  std::size_t length = 1;
  for (const std::string& value : array.values) {
    if (value.find('\0') != std::string::npos) {
      throw std::invalid_argument(path + ": a text holds a NUL");
    }
    length = std::max(length, value.size());
  }
  std::vector<char> flat(length * array.values.size(), '\0');
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    std::copy(array.values[i].begin(), array.values[i].end(),
              flat.begin() + static_cast<std::ptrdiff_t>(i * length));
  }
  const Hdf5Id type = MakeStringType(length);
  WriteDataset(path, type, type, array.shape, flat.data(), "");
}

std::vector<unsigned char> Hdf5ImageWriter::Finish() {
  RequireDone(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, "flush");
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  RequireDone(size > 0, "measure the file");
  std::vector<unsigned char> image(static_cast<std::size_t>(size));
  RequireDone(H5Fget_file_image(file_, image.data(), image.size()) == size, "copy the file");
  return image;
}

Hdf5ImageReader::Hdf5ImageReader(std::span<const unsigned char> image, std::string name,
                                 std::size_t most_bytes)
    : name_(std::move(name)),
      image_bytes_(image.size()),
      most_bytes_(static_cast<double>(most_bytes)),
      file_([&]() -> hid_t {
        const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS));
        if (image.empty()) return H5I_INVALID_HID;
        // The library copies the image, and takes a pointer to mutable bytes nevertheless.
        void* const bytes = const_cast<unsigned char*>(image.data());
        RequireDone(H5Pset_fapl_core(access, /*increment=*/4096, /*backing_store=*/false) >= 0 &&
                        H5Pset_file_image(access, bytes, image.size()) >= 0,
                    "set up a file");
        return H5Fopen("in memory", H5F_ACC_RDONLY, access);
      }()) {
  if (!file_.valid()) throw InputError(name_, "does not hold readable HDF5");
}

void Hdf5ImageReader::Claim(const std::string& path, double num_bytes) const {
  claimed_bytes_ += num_bytes;
  if (claimed_bytes_ > most_bytes_) {
    Fail(path, "with it the file would take more than " +
                   std::to_string(static_cast<std::size_t>(most_bytes_) >> 20) + " MiB of memory");
  }
}

void Hdf5ImageReader::Fail(const std::string& path, const std::string& why) const {
  throw InputError(name_, path + ": " + why);
}

std::int64_t Hdf5ImageReader::GetIntegerAttribute(const std::string& name) const {
  std::int64_t value = 0;
  const Hdf5Id attribute(H5Aopen(file_, name.c_str(), H5P_DEFAULT));
  if (!attribute.valid()) Fail(name, "the attribute is missing");
  const Hdf5Id space(H5Aget_space(attribute));
  if (H5Sget_simple_extent_npoints(space) != 1 ||
      H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0) {
    Fail(name, "the attribute is not a whole number");
  }
  return value;
}

Hdf5Id Hdf5ImageReader::OpenDataset(const std::string& path, H5T_class_t wanted_class) const {
  Hdf5Id dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT));
  if (!dataset.valid()) Fail(path, "is missing");
  const Hdf5Id type(H5Dget_type(dataset));
  if (H5Tget_class(type) != wanted_class) {
    Fail(path, wanted_class == H5T_STRING    ? "does not hold texts"
               : wanted_class == H5T_INTEGER ? "does not hold whole numbers"
                                             : "does not hold numbers");
  }
  return dataset;
}

std::vector<hsize_t> Hdf5ImageReader::CheckShape(const std::string& path, hid_t dataset,
                                                 const std::vector<hsize_t>& wanted) const {
  const Hdf5Id space(H5Dget_space(dataset));
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) Fail(path, "has no shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  const bool fits = std::equal(shape.begin(), shape.end(), wanted.begin(), wanted.end(),
                               [](hsize_t is, hsize_t want) { return want == kAny || is == want; });
  if (!fits) Fail(path, "has " + ToText(shape) + ", expected " + ToText(wanted));
  // A damaged shape must not ask for memory without end. Deflate packs at most 1032 bytes in one.
  const Hdf5Id type(H5Dget_type(dataset));
  const double num_bytes = std::accumulate(
      shape.begin(), shape.end(), static_cast<double>(H5Tget_size(type)),
      [](double product, hsize_t size) { return product * static_cast<double>(size); });
  const double most_bytes =
      1032.0 * static_cast<double>(std::min<hsize_t>(H5Dget_storage_size(dataset), image_bytes_));
  if (num_bytes > most_bytes) {
    Fail(path, "has " + ToText(shape) + ", more than the file can hold");
  }
  // A chunk is unpacked as a whole, whatever is asked for.
  const Hdf5Id creation(H5Dget_create_plist(dataset));
  if (H5Pget_layout(creation) == H5D_CHUNKED) {
    std::vector<hsize_t> chunk(shape.size());
    H5Pget_chunk(creation, rank, chunk.data());
    const bool is_within = std::equal(chunk.begin(), chunk.end(), shape.begin(), shape.end(),
                                      [](hsize_t part, hsize_t all) { return part <= all; });
    if (!is_within) Fail(path, "has chunks larger than itself");
  }
  const double value_bytes = static_cast<double>(H5Tget_size(type));
  const double least_bytes = H5Tget_class(type) == H5T_STRING
                                 ? value_bytes + static_cast<double>(sizeof(std::string))
                                 : static_cast<double>(sizeof(double));
  Claim(path, num_bytes / value_bytes * std::max(value_bytes, least_bytes));
  return shape;
}

Hdf5Array<double> Hdf5ImageReader::ReadDoubles(const std::string& path,
                                               const std::vector<hsize_t>& shape) const {
  const Hdf5Id dataset = OpenDataset(path, H5T_FLOAT);
  Hdf5Array<double> array{CheckShape(path, dataset, shape), {}};
  array.values.resize(NumValues(array.shape));
  if (!ReadAll(dataset, H5T_NATIVE_DOUBLE, array.values.size(), array.values.data())) {
    Fail(path, "cannot be read");
  }
  return array;
}

Hdf5Array<std::int64_t> Hdf5ImageReader::ReadIntegers(const std::string& path,
                                                      const std::vector<hsize_t>& shape) const {
  const Hdf5Id dataset = OpenDataset(path, H5T_INTEGER);
  Hdf5Array<std::int64_t> array{CheckShape(path, dataset, shape), {}};
  array.values.resize(NumValues(array.shape));
  if (!ReadAll(dataset, H5T_NATIVE_INT64, array.values.size(), array.values.data())) {
    Fail(path, "cannot be read");
  }
  return array;
}

Hdf5Array<std::string> Hdf5ImageReader::ReadStrings(const std::string& path,
                                                    const std::vector<hsize_t>& shape) const {
  const Hdf5Id dataset = OpenDataset(path, H5T_STRING);
  const Hdf5Id type(H5Dget_type(dataset));
  if (H5Tis_variable_str(type) != 0) Fail(path, "does not hold texts of fixed length");
  Hdf5Array<std::string> array{CheckShape(path, dataset, shape), {}};
  const std::size_t length = H5Tget_size(type);
  const std::size_t count = NumValues(array.shape);
  std::vector<char> flat(length * count);
  if (!ReadAll(dataset, type, count, flat.data())) {
    Fail(path, "cannot be read");
  }
  array.values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = flat.begin() + static_cast<std::ptrdiff_t>(i * length);
    array.values.emplace_back(begin,
                              std::find(begin, begin + static_cast<std::ptrdiff_t>(length), '\0'));
  }
  return array;
}

}  // namespace sidestep::record
