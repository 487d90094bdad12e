#pragma once

#include <hdf5.h>

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace sidestep::record {

/// While one lives, its thread alone uses the HDF5 library (which is not thread-safe as Debian
/// builds it), and the library does not print its error stack.
class Hdf5Session {
 public:
  Hdf5Session();
  ~Hdf5Session();
  Hdf5Session(const Hdf5Session&) = delete;
  Hdf5Session& operator=(const Hdf5Session&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* print_data_ = nullptr;
};

/// Owns an HDF5 identifier of any kind.
class Hdf5Id {
 public:
  explicit Hdf5Id(hid_t id = H5I_INVALID_HID) : id_(id) {}
  Hdf5Id(Hdf5Id&& other) noexcept : id_(other.id_) { other.id_ = H5I_INVALID_HID; }
  Hdf5Id& operator=(Hdf5Id&&) = delete;
  ~Hdf5Id() {
    if (id_ >= 0) H5Idec_ref(id_);
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
};

/// Numbers or texts in row-major order; an empty shape is a single value.
template <typename T>
struct Hdf5Array {
  std::vector<hsize_t> shape;
  std::vector<T> values;
};

/// Builds an HDF5 file in memory. The same calls give the same bytes: no time stamps, one fixed
/// format version, and every value stored little-endian. Arrays are shuffled and deflated.
/// Every method throws std::runtime_error if the library fails, std::invalid_argument if a shape
/// does not fit the values or a text holds a NUL.
class Hdf5ImageWriter {
 public:
  Hdf5ImageWriter();

  /// An attribute of the root group.
  void SetAttribute(const std::string& name, const std::string& value);
  void SetAttribute(const std::string& name, std::int64_t value);

  void MakeGroup(const std::string& path);
  /// Stores float64. A unit becomes the attribute `unit`.
  void Write(const std::string& path, const Hdf5Array<double>& array, const std::string& unit = "");
  /// Stores int64.
  void Write(const std::string& path, const Hdf5Array<std::int64_t>& array);
  /// Stores UTF-8 texts of one fixed length, filled up with NULs.
  void Write(const std::string& path, const Hdf5Array<std::string>& array);

  /// The bytes of the file. Nothing may be written afterwards.
  std::vector<unsigned char> Finish();

 private:
  void WriteDataset(const std::string& path, hid_t file_type, hid_t memory_type,
                    const std::vector<hsize_t>& shape, const void* data, const std::string& unit);
  void SetAttribute(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type,
                    const void* data);

  Hdf5Session session_;  // first in, last out
  Hdf5Id file_;
};

/// Reads an HDF5 file held in memory. Whatever is wrong becomes an InputError `NAME: PATH: WHY`.
/// Zeros are packed a thousandfold, so a small file may promise more than there is memory: what is
/// read is limited as a whole.
class Hdf5ImageReader {
 public:
  /// Far more than any trace of a minute holds.
  static constexpr std::size_t kMostBytes = std::size_t{2} << 30;

  /// @param name stands for the file in messages.
  /// @param most_bytes for all arrays that are read, as they are in memory.
  /// @throws InputError if this is not HDF5.
  Hdf5ImageReader(std::span<const unsigned char> image, std::string name,
                  std::size_t most_bytes = kMostBytes);

  std::int64_t GetIntegerAttribute(const std::string& name) const;

  /// In a wanted shape kAny accepts every size along that axis.
  static constexpr hsize_t kAny = static_cast<hsize_t>(-1);
  Hdf5Array<double> ReadDoubles(const std::string& path, const std::vector<hsize_t>& shape) const;
  Hdf5Array<std::int64_t> ReadIntegers(const std::string& path,
                                       const std::vector<hsize_t>& shape) const;
  Hdf5Array<std::string> ReadStrings(const std::string& path,
                                     const std::vector<hsize_t>& shape) const;

  /// Counts `num_bytes` that are to be made of what `path` holds; fails if all together are too
  /// many.
  void Claim(const std::string& path, double num_bytes) const;

  /// What may still be read.
  std::size_t bytes_left() const { return static_cast<std::size_t>(most_bytes_ - claimed_bytes_); }

  [[noreturn]] void Fail(const std::string& path, const std::string& why) const;

 private:
  Hdf5Id OpenDataset(const std::string& path, H5T_class_t wanted_class) const;
  std::vector<hsize_t> CheckShape(const std::string& path, hid_t dataset,
                                  const std::vector<hsize_t>& wanted) const;

  Hdf5Session session_;
  std::string name_;
  std::size_t image_bytes_;
  double most_bytes_;
  mutable double claimed_bytes_ = 0;
  Hdf5Id file_;
};

}  // namespace sidestep::record
