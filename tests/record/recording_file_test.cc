#include "sidestep/record/recording_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/record/hdf5_image.h"
#include "sidestep/record/sealed_file.h"
#include "tests/support/bytes_of.h"
#include "tests/support/full_recording.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::record {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const SealedFormat kFormat = {"sidestep trace", kTraceVersion};
constexpr std::size_t kHeadBytes = 512;

// A folder of its own for each test, gone afterwards.
class RecordingFile : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

 private:
  const TemporaryFolder folder_;
};

void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// What ReadRecording says about a file it refuses; fails the test if it accepts it.
std::string Refusal(const std::string& path) {
  try {
    ReadRecording(path);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

void ExpectEqual(double a, double b) { EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))); }

void ExpectEqual(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.translation(), b.translation());
  EXPECT_EQ(a.rotation().coeffs(), b.rotation().coeffs());
}

void ExpectEqual(const ControlSample& a, const ControlSample& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.q_command, b.q_command);
  EXPECT_EQ(a.v_command, b.v_command);
  EXPECT_EQ(a.a_command, b.a_command);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.torque, b.torque);
}

void ExpectEqual(const MotionLimits& a, const MotionLimits& b) {
  EXPECT_EQ(a.v_max, b.v_max);
  EXPECT_EQ(a.a_max, b.a_max);
  EXPECT_EQ(a.jerk_max, b.jerk_max);
  EXPECT_EQ(a.torque_rate_max, b.torque_rate_max);
}

void ExpectEqual(const TruthSample& a, const TruthSample& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.clearance_m, b.clearance_m);
  EXPECT_EQ(a.nearest_robot_part, b.nearest_robot_part);
  EXPECT_EQ(a.nearest_object, b.nearest_object);
  EXPECT_EQ(a.in_contact, b.in_contact);
  ExpectEqual(a.contact_s, b.contact_s);
  EXPECT_EQ(a.contact_object, b.contact_object);
  EXPECT_EQ(a.p_WContact, b.p_WContact);
  ASSERT_EQ(a.X_WO.size(), b.X_WO.size());
  for (std::size_t i = 0; i < a.X_WO.size(); ++i) ExpectEqual(a.X_WO[i], b.X_WO[i]);
}

void ExpectEqual(const PredictedObject& a, const PredictedObject& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.half_extents_m, b.half_extents_m);
  EXPECT_EQ(a.t, b.t);
  ASSERT_EQ(a.X_WO.size(), b.X_WO.size());
  for (std::size_t i = 0; i < a.X_WO.size(); ++i) ExpectEqual(a.X_WO[i], b.X_WO[i]);
}

void ExpectEqual(const ObservationRecord& a, const ObservationRecord& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.t_arrival, b.t_arrival);
  EXPECT_EQ(a.changed_cells, b.changed_cells);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].id, b.objects[i].id);
    ExpectEqual(a.objects[i].X_WO, b.objects[i].X_WO);
    EXPECT_EQ(a.objects[i].covariance, b.objects[i].covariance);
  }
}

void ExpectEqual(const CycleRecord& a, const CycleRecord& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.t_effect, b.t_effect);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.accepted, b.accepted);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.cut_short, b.cut_short);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.predicted_clearance_m, b.predicted_clearance_m);
  EXPECT_EQ(a.plan_start, b.plan_start);
  EXPECT_EQ(a.plan.t_s, b.plan.t_s);
  EXPECT_EQ(a.plan.q, b.plan.q);
  EXPECT_EQ(a.plan.v, b.plan.v);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) ExpectEqual(a.objects[i], b.objects[i]);
}

void ExpectEqual(const TrackEvent& a, const TrackEvent& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.what, b.what);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.other_id, b.other_id);
  EXPECT_EQ(a.p_W, b.p_W);
}

void ExpectEqual(const SafetyEvent& a, const SafetyEvent& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.check, b.check);
  EXPECT_EQ(a.reaction, b.reaction);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.limit, b.limit);
}

template <typename T>
void ExpectEqual(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ExpectEqual(a[i], b[i]);
}

void ExpectEqual(const Recording& a, const Recording& b) {
  EXPECT_EQ(a.header, b.header);
  EXPECT_EQ(a.scenario_yaml, b.scenario_yaml);
  EXPECT_EQ(a.model_xml, b.model_xml);
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.obstacles, b.obstacles);
  EXPECT_EQ(a.q_start, b.q_start);
  EXPECT_EQ(a.q_goal, b.q_goal);
  EXPECT_EQ(a.dwell_s, b.dwell_s);
  EXPECT_EQ(a.tolerance_scale, b.tolerance_scale);
  ExpectEqual(a.robot_limits, b.robot_limits);
  ExpectEqual(a.limits, b.limits);
  EXPECT_EQ(a.tool_a_max, b.tool_a_max);
  EXPECT_EQ(a.tool_a_reflex, b.tool_a_reflex);
  EXPECT_EQ(a.p_WTool, b.p_WTool);
  ExpectEqual(a.control, b.control);
  ExpectEqual(a.truth, b.truth);
  ExpectEqual(a.cycles, b.cycles);
  ExpectEqual(a.events, b.events);
  ExpectEqual(a.safety, b.safety);
  ExpectEqual(a.observations, b.observations);
  ASSERT_EQ(a.metrics.size(), b.metrics.size());
  for (const auto& [name, value] : a.metrics) ExpectEqual(value, b.metrics.at(name));
}

TEST_F(RecordingFile, GivesBackEveryFieldExactly) {
  const Recording recording = FullRecording();
  WriteRecording(recording, Path("trace.h5"));
  ExpectEqual(recording, ReadRecording(Path("trace.h5")));
}

TEST_F(RecordingFile, GivesBackARecordingInWhichNothingHappened) {
  const Recording nothing;
  WriteRecording(nothing, Path("trace.h5"));
  ExpectEqual(nothing, ReadRecording(Path("trace.h5")));
}

TEST_F(RecordingFile, HasEqualBytesForEqualRecordings) {
  WriteRecording(FullRecording(), Path("a.h5"));
  sleep(1);  // HDF5's time stamps count whole seconds.
  WriteRecording(FullRecording(), Path("b.h5"));
  WriteRecording(ReadRecording(Path("a.h5")), Path("c.h5"));
  const std::string bytes = BytesOf(Path("a.h5"));
  EXPECT_EQ(bytes, BytesOf(Path("b.h5")));
  EXPECT_EQ(bytes, BytesOf(Path("c.h5")));

  Recording other = FullRecording();
  other.control[4999].torque(1) = std::nextafter(1e300, 0.0);
  WriteRecording(other, Path("d.h5"));
  EXPECT_NE(bytes, BytesOf(Path("d.h5")));
}

TEST_F(RecordingFile, OpensAsPlainHdf5) {
  WriteRecording(FullRecording(), Path("trace.h5"));
  const hid_t file = H5Fopen(Path("trace.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t dataset = H5Dopen2(file, "control/q", H5P_DEFAULT);
  ASSERT_GE(dataset, 0);
  std::vector<double> q(5000 * 2);
  EXPECT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, q.data()), 0);
  EXPECT_EQ(q[2 * 4321], 4321.2);
  H5Dclose(dataset);
  H5Fclose(file);
}

TEST_F(RecordingFile, ReplacesAnOlderFileAndLeavesNothingElseBehind) {
  WriteBytes(Path("trace.h5"), "something older");
  WriteRecording(FullRecording(), Path("trace.h5"));
  ExpectEqual(FullRecording(), ReadRecording(Path("trace.h5")));
  const auto folder = std::filesystem::path(Path("trace.h5")).parent_path();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(RecordingFile, SaysWhyAFileCannotBeWrittenAndLeavesNothingBehind) {
  try {
    WriteRecording(FullRecording(), Path("absent/trace.h5"));
    FAIL() << "was written";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              Path("absent/trace.h5") + ": cannot be written: No such file or directory");
  }
  std::filesystem::create_directories(Path("folder/inner"));
  EXPECT_THROW(WriteRecording(FullRecording(), Path("folder")), InputError);
  const auto folder = std::filesystem::path(Path("folder")).parent_path();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(RecordingFile, RefusesToWriteARecordingThatDisagreesWithItself) {
  const std::function<void(Recording&)> faults[] = {
      [](Recording& r) { r.q_start.resize(3); },
      [](Recording& r) { r.robot_limits.v_max.resize(0); },
      [](Recording& r) { r.limits.jerk_max.resize(1); },
      [](Recording& r) { r.control[7].torque.resize(1); },
      [](Recording& r) { r.p_WTool.pop_back(); },
      [](Recording& r) { r.control[7].t = r.control[8].t; },
      [](Recording& r) { r.truth[1].X_WO.pop_back(); },
      [](Recording& r) { r.cycles[0].plan.v.resize(2, 1); },
      [](Recording& r) { r.cycles[2].objects[1].t.pop_back(); },
      [](Recording& r) { r.scenario_yaml[3] = '\0'; },
  };
  for (std::size_t i = 0; i < std::size(faults); ++i) {
    Recording recording = FullRecording();
    faults[i](recording);
    EXPECT_THROW(WriteRecording(recording, Path("trace.h5")), std::invalid_argument) << i;
    EXPECT_FALSE(std::filesystem::exists(Path("trace.h5"))) << i;
  }
}

TEST_F(RecordingFile, SaysWhatIsWrongWithAFileThatIsNone) {
  EXPECT_EQ(Refusal(Path("absent.h5")), Path("absent.h5") + ": no such file");
  EXPECT_EQ(Refusal(Path("")), Path("") + ": is a directory, not a file");
  WriteBytes(Path("empty.h5"), "");
  EXPECT_EQ(Refusal(Path("empty.h5")), Path("empty.h5") + ": is empty");
  WriteBytes(Path("text.h5"), "name: hsr_walkway\n");
  EXPECT_EQ(Refusal(Path("text.h5")), Path("text.h5") + ": is not a sidestep trace file");
  EXPECT_EQ(Refusal("/dev/zero"), "/dev/zero: is not a regular file");
}

TEST_F(RecordingFile, NamesTheVersionItCannotRead) {
  WriteSealedFile(Path("new.h5"), {"sidestep trace", kTraceVersion + 1}, {});
  EXPECT_EQ(Refusal(Path("new.h5")),
            Path("new.h5") + ": is of version " + std::to_string(kTraceVersion + 1) +
                " of the sidestep trace format; this program reads version " +
                std::to_string(kTraceVersion));
}

TEST_F(RecordingFile, IsRefusedWhereverItIsCut) {
  WriteRecording(FullRecording(), Path("whole.h5"));
  const std::string whole = BytesOf(Path("whole.h5"));
  ASSERT_GT(whole.size(), 10000u);
  for (std::size_t size = 1; size < whole.size(); size += size < 1200 ? 37 : 4001) {
    WriteBytes(Path("cut.h5"), whole.substr(0, size));
    EXPECT_THAT(Refusal(Path("cut.h5")),
                AllOf(StartsWith(Path("cut.h5") + ": is "), Not(HasSubstr("\n"))));
  }
  WriteBytes(Path("cut.h5"), whole.substr(0, whole.size() - 1));
  EXPECT_EQ(Refusal(Path("cut.h5")), Path("cut.h5") + ": is cut off: it holds " +
                                         std::to_string(whole.size() - kHeadBytes - 1) + " of " +
                                         std::to_string(whole.size() - kHeadBytes) + " bytes");
  WriteBytes(Path("cut.h5"), whole + "x");
  EXPECT_EQ(Refusal(Path("cut.h5")),
            Path("cut.h5") + ": is damaged: its contents do not match its checksum");
}

// The shortest recording there is.
Recording SmallRecording() {
  Recording small;
  small.joints = {"hinge"};
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  small.q_start = small.q_goal = one;
  small.limits = small.robot_limits = {one, one, one, one};
  return small;
}

TEST_F(RecordingFile, IsRefusedAtEveryLengthButItsOwn) {
  const std::string path = Path("cut.h5");
  WriteRecording(SmallRecording(), path);
  for (std::uintmax_t size = std::filesystem::file_size(path); size-- > 0;) {
    std::filesystem::resize_file(path, size);
    const std::string refusal = Refusal(path);
    ASSERT_TRUE(refusal.starts_with(path + (size == 0 ? ": is empty" : ": is ")) &&
                refusal.find('\n') == std::string::npos)
        << size << ": " << refusal;
  }
}

TEST_F(RecordingFile, IsRefusedWhicheverByteIsDamaged) {
  const std::string path = Path("damaged.h5");
  WriteRecording(SmallRecording(), path);
  const std::string whole = BytesOf(path);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&](std::size_t i, char byte) {
    file.seekp(static_cast<std::streamoff>(i)).put(byte).flush();
  };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    put(i, static_cast<char>(whole[i] ^ (1 << (i % 8))));
    const std::string refusal = Refusal(path);
    ASSERT_TRUE(refusal.starts_with(path + ": ")) << i << ": " << refusal;
    put(i, whole[i]);
  }
}

// Files whose seal is right and whose contents are not, as a faulty writer would leave them.
struct Fault {
  std::string name;
  std::string dataset;  // replaced ...
  std::vector<hsize_t> shape;
  // ... by these; without any: by a mere promise of that shape, or left out if that is empty, too.
  std::vector<double> values;
  std::string message;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

class FaultyContents : public RecordingFile, public ::testing::WithParamInterface<Fault> {};

// The HDF5 bytes of a recording with one dataset replaced or deleted.
std::vector<unsigned char> WithFault(const std::string& path, const Fault& fault) {
  std::vector<unsigned char> payload = ReadSealedFile(path, kFormat);
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS));
  EXPECT_GE(H5Pset_fapl_core(access, 4096, false), 0);
  EXPECT_GE(H5Pset_file_image(access, payload.data(), payload.size()), 0);
  const Hdf5Id file(H5Fopen("in memory", H5F_ACC_RDWR, access));
  EXPECT_GE(H5Ldelete(file, fault.dataset.c_str(), H5P_DEFAULT), 0) << fault.dataset;
  if (!fault.shape.empty()) {
    const int rank = static_cast<int>(fault.shape.size());
    const std::vector<hsize_t> chunk(fault.shape.size(), 1);
    const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE));
    EXPECT_GE(H5Pset_chunk(creation, rank, chunk.data()), 0);
    const Hdf5Id space(H5Screate_simple(rank, fault.shape.data(), nullptr));
    const Hdf5Id dataset(H5Dcreate2(file, fault.dataset.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                    creation, H5P_DEFAULT));
    EXPECT_TRUE(dataset.valid());
    if (!fault.values.empty()) {
      EXPECT_GE(
          H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, fault.values.data()),
          0);
    }
  }
  EXPECT_GE(H5Fflush(file, H5F_SCOPE_GLOBAL), 0);
  std::vector<unsigned char> image(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)));
  EXPECT_GT(H5Fget_file_image(file, image.data(), image.size()), 0);
  return image;
}

TEST_P(FaultyContents, AreRefusedWithTheirReason) {
  WriteRecording(FullRecording(), Path("good.h5"));
  WriteSealedFile(Path("bad.h5"), kFormat, WithFault(Path("good.h5"), GetParam()));
  EXPECT_EQ(Refusal(Path("bad.h5")), Path("bad.h5") + ": " + GetParam().message);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    RecordingFile, FaultyContents,
    ::testing::Values(
        Fault{"Missing", "truth/clearance", {}, {}, "truth/clearance: is missing"},
        Fault{"MissingGroup", "cycles", {}, {}, "cycles/t: is missing"},
        Fault{"OtherType", "cycles/status", {3}, {1, 2, 3}, "cycles/status: does not hold texts"},
        Fault{"OtherRank", "q_goal", {1, 2}, {1, 2}, "q_goal: has shape 1 x 2, expected shape 2"},
        Fault{"DwellMissing", "dwell", {}, {}, "dwell: is missing"},
        Fault{"DwellOfManyNumbers",
              "dwell",
              {2},
              {0, 1},
              "dwell: has shape 2, expected a single value"},
        Fault{"LimitsOfAnotherArm",
              "limits/a_max",
              {3},
              {1, 2, 3},
              "limits/a_max: has shape 3, expected shape 2"},
        Fault{"TooShort",
              "truth/clearance",
              {2},
              {1, 2},
              "truth/clearance: has shape 2, expected shape 3"},
        Fault{"Endless",
              "cycles/t",
              {1'000'000'000'000},
              {},
              "cycles/t: has shape 1000000000000, more than the file can hold"},
        Fault{"TimeNotFinite",
              "cycles/t",
              {3},
              {0, kNan, 1},
              "cycles/t: holds a time that is not from 0 to 3600 s"},
        Fault{"TimeDoesNotIncrease", "truth/t", {3}, {0, 1, 1}, "truth/t: does not increase"},
        Fault{"OffsetsOfAnotherType",
              "plans/offset",
              {4},
              {0, 3, 3, 8},
              "plans/offset: does not hold whole numbers"},
        Fault{"PlanNotFinite",
              "plans/t",
              {8},
              {0, 1.5, 1.5, 0, 0.75, 1.5, 2.25, 3},
              "plans: cycle 0: trajectory: times must increase strictly"},
        Fault{"ToolOfOtherTicks",
              "tool/position",
              {1, 3},
              {1, 2, 3},
              "tool/position: must have one row a control tick, or none"},
        Fault{"FindingWithoutALimit",
              "safety/limit",
              {1},
              {0.3},
              "safety/limit: has shape 1, expected shape 2"},
        Fault{"ArrivalMissing",
              "observations/t_arrival",
              {},
              {},
              "observations/t_arrival: is missing"},
        Fault{"CovarianceOfAnotherShape",
              "observations/objects/covariance",
              {3, 6},
              std::vector<double>(18, 0),
              "observations/objects/covariance: has shape 3 x 6, expected shape 3 x 36"},
        Fault{"PoseZero",
              "predictions/poses/quaternion",
              {4, 4},
              std::vector<double>(16, 0),
              "predictions/poses/quaternion: row 0 is not a finite pose"}),
    [](const auto& test) { return test.param.name; });

TEST(Hdf5ImageReader, ReadsNoMoreThanItMayTakeOfMemory) {
  const std::vector<double> zeros(1'000'000, 0);
  const std::vector<unsigned char> image = [&] {  // one writer or reader at a time
    Hdf5ImageWriter writer;
    writer.Write("a", {{zeros.size()}, zeros});
    writer.Write("b", {{zeros.size()}, zeros});
    writer.Write("words", {{2}, std::vector<std::string>{"on", "off"}});
    return writer.Finish();
  }();
  EXPECT_LT(image.size(), 100'000u);  // 16 MB
  {
    const Hdf5ImageReader enough(image, "t.h5", 17'000'000);
    EXPECT_EQ(enough.ReadDoubles("a", {Hdf5ImageReader::kAny}).values, zeros);
    EXPECT_EQ(enough.ReadDoubles("b", {Hdf5ImageReader::kAny}).values, zeros);
    EXPECT_EQ(enough.ReadStrings("words", {2}).values.size(), 2u);
  }
  const Hdf5ImageReader too_little(image, "t.h5", 15'000'000);
  too_little.ReadDoubles("a", {Hdf5ImageReader::kAny});
  EXPECT_THAT([&] { too_little.ReadDoubles("b", {Hdf5ImageReader::kAny}); },
              ::testing::ThrowsMessage<InputError>(
                  "t.h5: b: with it the file would take more than 14 MiB of memory"));
}

// An array that could grow may have chunks larger than itself, and each is unpacked as a whole.
TEST(Hdf5ImageReader, RefusesChunksLargerThanTheirArray) {
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access, 4096, false);
  const Hdf5Id file(H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, access));
  const hsize_t size = 10, chunk = 100'000, most = H5S_UNLIMITED;
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(creation, 1, &chunk);
  H5Pset_deflate(creation, 9);
  const Hdf5Id space(H5Screate_simple(1, &size, &most));
  const Hdf5Id dataset(
      H5Dcreate2(file, "a", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  const std::vector<double> zeros(size, 0);
  ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), 0);
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::vector<unsigned char> image(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)));
  ASSERT_GT(H5Fget_file_image(file, image.data(), image.size()), 0);
  const Hdf5ImageReader reader(image, "t.h5");
  EXPECT_THAT([&] { reader.ReadDoubles("a", {Hdf5ImageReader::kAny}); },
              ::testing::ThrowsMessage<InputError>("t.h5: a: has chunks larger than itself"));
}

TEST_F(RecordingFile, IsRefusedWithoutReadableHdf5Inside) {
  const std::vector<unsigned char> noise(5000, 0x5a);
  WriteSealedFile(Path("noise.h5"), kFormat, noise);
  EXPECT_EQ(Refusal(Path("noise.h5")), Path("noise.h5") + ": does not hold readable HDF5");
  WriteSealedFile(Path("nothing.h5"), kFormat, {});
  EXPECT_EQ(Refusal(Path("nothing.h5")), Path("nothing.h5") + ": does not hold readable HDF5");
}

}  // namespace
}  // namespace sidestep::record
