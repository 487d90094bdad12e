// Any file is refused with an InputError, or is a recording. The checksum of a trace would stop
// nearly everything at once, and damage inside HDF5's own structures is the library's to find. So
// what is fuzzed is what a faulty writer could leave: a good trace, of which some datasets are
// missing, replaced by others of any type, shape and values, or changed in one value. What is a
// recording is drawn from its model, so that is compiled, too, or refused: of a world like ours,
// parts are replaced by other parts of such worlds or by anything.
#include <fuzzer/FuzzedDataProvider.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/record/hdf5_image.h"
#include "sidestep/record/journal.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/record/sealed_file.h"
#include "sidestep/sim/foreign_model.h"
#include "tests/fuzz/memory_file.h"
#include "tests/support/full_recording.h"

namespace sidestep {
namespace {

const record::SealedFormat kFormat = {"sidestep trace", record::kTraceVersion};
const record::SealedFormat kJournalFormat = {"sidestep journal", record::kTraceVersion};

constexpr const char* kGoodModel = R"(<mujoco model="small"><option timestep="0.001"/>
<size nconmax="200" njmax="800"/><visual><quality shadowsize="2048"/></visual>
<default><geom rgba="1 0 0 1" density="800"/></default>
<asset><texture name="sky" type="skybox" builtin="gradient" width="16" height="16"/>
<material name="m" rgba="0 1 0 1"/></asset>
<worldbody><geom name="floor" type="plane" size="0 0 1" material="m"/><light pos="0 0 3"/>
<camera name="top" pos="0 0 3" xyaxes="1 0 0 0 1 0"/>
<body name="link"><joint name="turn" axis="0 0 1" range="-2 2" limited="true"/>
<geom type="capsule" fromto="0 0 0 0 0 1" size="0.1"/><site name="dh1" pos="0 0 1"/></body>
<body name="box" mocap="true" pos="0 0 2"><geom type="box" size="1 1 1"/></body></worldbody>
<contact><exclude body1="link" body2="box"/></contact>
<actuator><motor name="push" joint="turn" ctrlrange="-1 1" ctrllimited="true"/></actuator>
</mujoco>)";

// What may stand in a model, in place of some of it.
constexpr const char* kModelParts[] = {
    "<body>",
    "</body>",
    "<joint/>",
    "<freejoint/>",
    "<geom size='1'/>",
    "<site/>",
    "\"ball\"",
    "\"free\"",
    "\"mesh\"",
    "\"ellipsoid\"",
    "<mesh name='t' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/>",
    "<size njmax='7000'/>",
    "<size nconmax='1000000'/>",
    "<size nstack='1'/>",
    "<composite/>",
    "<inertial pos='0 0 0' mass='1e-300' diaginertia='1 1 1'/>",
    "<tendon><spatial><site site='dh1'/>",
    "<sensor><touch site='dh1'/></sensor>",
    "<equality><weld body1='link'/></equality>",
    "<default class='a'>",
    "</default>",
    " mass='1e300'",
    " file='/etc/passwd'",
    " quat='0 0 0 0'",
    " euler='1 2 3'",
    " nan",
    " 1e308",
    " -1",
    "\"\"",
    "<compiler angle='degree' coordinate='global'/>",
    "<texture builtin='flat' type='cube' width='4096' height='4096'/>",
    "<user dim='-5'/>"};

std::string AnyModel(FuzzedDataProvider& data) {
  std::string xml = kGoodModel;
  for (int edits = data.ConsumeIntegralInRange(0, 4); edits > 0; --edits) {
    const auto at = data.ConsumeIntegralInRange<std::size_t>(0, xml.size());
    const auto length = data.ConsumeIntegralInRange<std::size_t>(0, 40);
    xml.replace(at, length,
                data.ConsumeBool() ? data.PickValueInArray(kModelParts)
                                   : data.ConsumeRandomLengthString(60));
  }
  return xml.substr(0, xml.find('\0'));
}

std::vector<unsigned char> GoodPayload() {
  char folder[] = "/tmp/trace_fuzzer_XXXXXX";
  if (mkdtemp(folder) == nullptr) std::abort();
  const std::string path = std::string(folder) + "/good.h5";
  record::Recording recording = FullRecording(3);
  recording.model_xml = kGoodModel;
  record::WriteRecording(recording, path);
  std::vector<unsigned char> payload = record::ReadSealedFile(path, kFormat);
  unlink(path.c_str());
  rmdir(folder);
  return payload;
}

// An HDF5 file in memory that can be changed.
record::Hdf5Id OpenImage(std::vector<unsigned char> image) {
  const record::Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access, 4096, false);
  H5Pset_file_image(access, image.data(), image.size());
  return record::Hdf5Id(H5Fopen("in memory", H5F_ACC_RDWR, access));
}

std::vector<unsigned char> ImageOf(const record::Hdf5Id& file) {
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::vector<unsigned char> image(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)));
  if (H5Fget_file_image(file, image.data(), image.size()) < 0) std::abort();
  return image;
}

std::vector<std::string> DatasetsOf(const record::Hdf5Id& file) {
  std::vector<std::string> paths;
  const auto collect = [](hid_t, const char* path, const H5O_info_t* info, void* to) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) {
      static_cast<std::vector<std::string>*>(to)->emplace_back(path);
    }
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, collect, &paths, H5O_INFO_BASIC);
  return paths;
}

// Bytes for `num_bytes` of values: what the input still has, over and over.
std::vector<unsigned char> Values(FuzzedDataProvider& data, std::size_t num_bytes) {
  std::vector<unsigned char> pattern =
      data.ConsumeBytes<unsigned char>(data.ConsumeIntegralInRange<std::size_t>(1, 64));
  if (pattern.empty()) pattern = {0};
  std::vector<unsigned char> bytes(num_bytes);
  for (std::size_t i = 0; i < num_bytes; ++i) bytes[i] = pattern[i % pattern.size()];
  return bytes;
}

record::Hdf5Id AnyType(FuzzedDataProvider& data) {
  switch (data.ConsumeIntegralInRange(0, 3)) {
    case 0:
      return record::Hdf5Id(H5Tcopy(H5T_NATIVE_DOUBLE));
    case 1:
      return record::Hdf5Id(H5Tcopy(H5T_NATIVE_INT64));
    case 2:
      return record::Hdf5Id(H5Tcopy(H5T_NATIVE_INT8));
    default:
      break;
  }
  record::Hdf5Id text(H5Tcopy(H5T_C_S1));
  H5Tset_size(text, data.ConsumeIntegralInRange<std::size_t>(1, 20));
  return text;
}

void Replace(const record::Hdf5Id& file, const std::string& path, FuzzedDataProvider& data) {
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  const record::Hdf5Id type = AnyType(data);
  std::vector<hsize_t> shape(data.ConsumeIntegralInRange<std::size_t>(0, 3));
  const bool huge = data.ConsumeProbability<float>() > 0.9f;
  std::size_t num_values = 1;
  for (hsize_t& size : shape) {
    size = huge ? data.ConsumeIntegral<std::uint64_t>() : data.ConsumeIntegralInRange(0, 40);
    num_values *= size;
  }
  const record::Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE));
  if (huge && !shape.empty()) {
    const std::vector<hsize_t> chunk(shape.size(), 1);
    H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  }
  const record::Hdf5Id space(
      shape.empty() ? H5Screate(H5S_SCALAR)
                    : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
  const record::Hdf5Id dataset(
      H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  if (huge || !dataset.valid()) return;
  const auto values = Values(data, num_values * H5Tget_size(type));
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void ChangeOneValue(const record::Hdf5Id& file, const std::string& path, FuzzedDataProvider& data) {
  const record::Hdf5Id dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT));
  if (!dataset.valid()) return;  // it was deleted
  const record::Hdf5Id type(H5Dget_type(dataset)), space(H5Dget_space(dataset));
  const std::size_t value_bytes = H5Tget_size(type);
  const hssize_t num_values = H5Sget_simple_extent_npoints(space);
  if (num_values <= 0 || num_values > 10000) return;
  std::vector<unsigned char> values(static_cast<std::size_t>(num_values) * value_bytes);
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
  const auto at = value_bytes * data.ConsumeIntegralInRange<std::size_t>(
                                    0, static_cast<std::size_t>(num_values) - 1);
  const auto value = Values(data, value_bytes);
  std::copy(value.begin(), value.end(), values.begin() + static_cast<std::ptrdiff_t>(at));
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void ReplaceModel(const record::Hdf5Id& file, FuzzedDataProvider& data) {
  const std::string xml = AnyModel(data);
  H5Ldelete(file, "model_xml", H5P_DEFAULT);
  const record::Hdf5Id type(H5Tcopy(H5T_C_S1)), space(H5Screate(H5S_SCALAR));
  H5Tset_size(type, std::max<std::size_t>(1, xml.size()));
  const record::Hdf5Id dataset(
      H5Dcreate2(file, "model_xml", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, xml.c_str());
}

std::string FaultyTrace(FuzzedDataProvider& data, const record::SealedFormat& format) {
  static const std::vector<unsigned char> good = GoodPayload();
  static const std::vector<std::string> paths = DatasetsOf(OpenImage(good));
  const record::Hdf5Session session;
  const record::Hdf5Id file = OpenImage(good);
  const int num_faults = data.ConsumeIntegralInRange(0, 3);
  for (int i = 0; i < num_faults; ++i) {
    const std::string& path = paths[data.ConsumeIntegralInRange<std::size_t>(0, paths.size() - 1)];
    switch (data.ConsumeIntegralInRange(0, 3)) {
      case 3:
        ReplaceModel(file, data);
        break;
      case 0:
        H5Ldelete(file, path.c_str(), H5P_DEFAULT);
        break;
      case 1:
        Replace(file, path, data);
        break;
      default:
        ChangeOneValue(file, path, data);
        break;
    }
  }
  return record::SealedBytes(format, ImageOf(file));
}

// A good part, then any.
void ReadAsJournal(const std::string& bytes) {
  static const std::string good = record::SealedBytes(kJournalFormat, GoodPayload());
  const std::string all = good + bytes;
  const MemoryFile file(reinterpret_cast<const std::uint8_t*>(all.data()), all.size());
  const record::Recording recording = record::ReadJournal(file.path()).recording;
  if (recording.control.empty() || record::ToHdf5(recording).empty()) std::abort();
}

void Read(const std::string& bytes) {
  const MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  try {
    const record::Recording recording = record::ReadRecording(file.path());
    const sim::MujocoModelPtr model = sim::LoadForeignModel(recording.model_xml, "trace");
    mj_kinematics(model.get(), sim::MakeMujocoData(*model).get());
  } catch (const InputError&) {
  }
}

}  // namespace
}  // namespace sidestep

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  const bool as_it_is = data.ConsumeProbability<float>() > 0.95f;
  const bool is_journal = data.ConsumeBool();
  const std::string input =
      as_it_is
          ? data.ConsumeRemainingBytesAsString()
          : sidestep::FaultyTrace(data, is_journal ? sidestep::kJournalFormat : sidestep::kFormat);
  is_journal ? sidestep::ReadAsJournal(input) : sidestep::Read(input);
  return 0;
}
