// A recording that grows, as it is on the disk at any moment.
#include "sidestep/record/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/record/sealed_file.h"
#include "tests/support/bytes_of.h"
#include "tests/support/full_recording.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::record {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::map<std::string, std::string> kFacts = {{"identity.run", "abc"}};

// What is there after `share` of an episode.
Recording Beginning(const Recording& whole, double share) {
  Recording part = whole;
  const auto cut = [&](auto& rows) {
    rows.resize(static_cast<std::size_t>(share * static_cast<double>(rows.size())));
  };
  cut(part.control);
  cut(part.p_WTool);
  cut(part.truth);
  cut(part.observations);
  cut(part.cycles);
  cut(part.events);
  cut(part.safety);
  return part;
}

Recording WithoutMetrics(Recording recording) {
  recording.metrics.clear();
  return recording;
}

std::vector<unsigned char> WithFacts(Recording recording) {
  recording.header.insert(kFacts.begin(), kFacts.end());
  return ToHdf5(recording);
}

void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void WaitUntil(const std::function<bool()>& is_so) {
  for (int i = 0; i < 6000 && !is_so(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(is_so());
}

std::string Refusal(const std::string& path) {
  try {
    ReadJournal(path);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

class JournalFile : public ::testing::Test {
 protected:
  std::size_t Size() const {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path_, error);
    return error ? 0 : size;
  }

  // Where the parts of the file end: where the next one begins by naming the format.
  std::vector<std::size_t> PartEnds() const {
    const std::string bytes = BytesOf(path_);
    std::vector<std::size_t> ends;
    for (std::size_t at = 0; at != std::string::npos;) {
      at = bytes.find("sidestep journal", at + 1);
      ends.push_back(std::min(at, bytes.size()));
    }
    return ends;
  }

  // Keeps one beginning of it after the other, each in a part of its own. @return the sizes of the
  // file then.
  std::vector<std::size_t> KeepInParts(const Recording& whole, const std::vector<double>& shares) {
    Journal journal(path_, kFacts, [](const std::string& why) { ADD_FAILURE() << why; });
    for (std::size_t i = 0; i < shares.size(); ++i) {
      journal.Keep(Beginning(whole, shares[i]));
      WaitUntil([&] { return PartEnds().size() > i && Size() > 0; });
    }
    EXPECT_TRUE(journal.Close());
    std::vector<std::size_t> ends = PartEnds();
    EXPECT_EQ(ends.size(), shares.size());
    return ends;
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_.path() / "trace.journal";
};

TEST_F(JournalFile, GivesBackWhatWasKeptPartByPart) {
  const Recording whole = WithoutMetrics(FullRecording(90));
  KeepInParts(whole, {0, 0.4, 0.7, 1});
  const JournalContents contents = ReadJournal(path_);
  EXPECT_EQ(contents.damage, "");
  EXPECT_EQ(ToHdf5(contents.recording), WithFacts(whole));
}

TEST_F(JournalFile, HasTheProblemBeforeAnythingHappens) {
  const Recording whole = WithoutMetrics(FullRecording(90));
  Journal journal(path_, kFacts, {});
  journal.Keep(Beginning(whole, 0));
  EXPECT_TRUE(journal.Close());
  EXPECT_EQ(ToHdf5(ReadJournal(path_).recording), WithFacts(Beginning(whole, 0)));
}

TEST_F(JournalFile, SaysWhetherAllIsThereEvenIfNothingCameAtTheEnd) {
  const Recording whole = WithoutMetrics(FullRecording(90));
  Journal journal(path_, kFacts, {});
  journal.Keep(whole);
  WaitUntil([&] { return Size() > 0; });
  journal.Keep(whole);
  EXPECT_TRUE(journal.Close());
  EXPECT_EQ(ToHdf5(ReadJournal(path_).recording), WithFacts(whole));
}

TEST_F(JournalFile, IsReadUpToTheLastPartThatIsWhole) {
  const Recording whole = WithoutMetrics(FullRecording(9));
  const std::vector<double> shares = {0.4, 0.7, 1};
  const std::vector<std::size_t> sizes = KeepInParts(whole, shares);
  const std::string bytes = BytesOf(path_);
  ASSERT_EQ(sizes.back(), bytes.size());
  const std::string cut = folder_.path() / "cut";
  const auto is_border = [&](std::size_t size) {
    return std::any_of(sizes.begin(), sizes.end(), [&](std::size_t end) {
      return size + 1 == end || size == end || size == end + 1 || size == end + 512;
    });
  };
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    if (!is_border(size) && size % 997 != 0) continue;
    WriteBytes(cut, bytes.substr(0, size));
    if (size < sizes.front()) {
      ASSERT_THAT(Refusal(cut), StartsWith(cut + ": is ")) << size;
      continue;
    }
    std::size_t num_whole = 0;
    while (num_whole < sizes.size() && sizes[num_whole] <= size) ++num_whole;
    const JournalContents contents = ReadJournal(cut);
    ASSERT_EQ(contents.damage.empty(), size == sizes[num_whole - 1]) << size;
    ASSERT_EQ(contents.recording.control.size(),
              Beginning(whole, shares[num_whole - 1]).control.size());
  }
}

// The same at every byte, of parts that hold hardly anything.
TEST_F(JournalFile, IsARowOfPartsEachOfWhichCanTellWhetherItIsWhole) {
  const SealedFormat format = {"row", 1};
  const std::vector<std::vector<unsigned char>> payloads = {{'a', 'b', 'c'}, {}, {'d', 'e'}};
  std::string bytes;
  std::vector<std::size_t> sizes;
  for (const auto& payload : payloads) {
    bytes += SealedBytes(format, payload);
    sizes.push_back(bytes.size());
  }
  const auto num_whole_in = [&](std::size_t size) {
    return static_cast<std::size_t>(std::upper_bound(sizes.begin(), sizes.end(), size) -
                                    sizes.begin());
  };
  const auto check = [&](const std::string& what, std::size_t num_whole, bool is_damaged) {
    WriteBytes(path_, what);
    if (num_whole == 0) {
      EXPECT_THROW(ReadSealedRow(path_, format), InputError);
      return;
    }
    const SealedRow row = ReadSealedRow(path_, format);
    EXPECT_EQ(row.damage.empty(), !is_damaged);
    ASSERT_EQ(row.payloads.size(), num_whole);
    EXPECT_TRUE(std::equal(row.payloads.begin(), row.payloads.end(), payloads.begin()));
  };
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const std::size_t num_whole = num_whole_in(size);
    check(bytes.substr(0, size), num_whole, num_whole > 0 && size != sizes[num_whole - 1]);
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    check(damaged, num_whole_in(i), true);
  }
}

TEST_F(JournalFile, IsReadUpToWhereItIsDamaged) {
  const Recording whole = WithoutMetrics(FullRecording(9));
  const std::vector<std::size_t> sizes = KeepInParts(whole, {0.4, 0.7, 1});
  const std::string bytes = BytesOf(path_);
  for (std::size_t i = 0; i < bytes.size(); i += 1999) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    WriteBytes(path_, damaged);
    if (i < sizes[0]) {
      ASSERT_THAT(Refusal(path_), StartsWith(path_ + ": is ")) << i;
    } else {
      const JournalContents contents = ReadJournal(path_);
      ASSERT_THAT(contents.damage, StartsWith("from byte ")) << i;
      ASSERT_EQ(contents.recording.control.size(), i < sizes[1] ? 3u : 6u) << i;
    }
  }
}

TEST_F(JournalFile, LeavesOutPartsThatDoNotGoOn) {
  const Recording whole = WithoutMetrics(FullRecording(9));
  const std::vector<std::size_t> sizes = KeepInParts(whole, {0.4, 1});
  const std::string bytes = BytesOf(path_);
  const std::string second = bytes.substr(sizes[0]);
  WriteBytes(path_, bytes + second);  // the same again
  const JournalContents contents = ReadJournal(path_);
  EXPECT_EQ(contents.damage, path_ + ": does not go on as it began");
  EXPECT_EQ(ToHdf5(contents.recording), WithFacts(whole));
}

TEST_F(JournalFile, GoesWhenItsRecordingIsSafeElsewhere) {
  Journal journal(path_, kFacts, {});
  journal.Keep(FullRecording(9));
  WaitUntil([&] { return Size() > 0; });
  journal.Remove();
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(JournalFile, ReplacesAnOlderOneNotBeforeItHasSomethingToSay) {
  WriteBytes(path_, "older");
  { const Journal nothing(path_, kFacts, {}); }
  EXPECT_EQ(BytesOf(path_), "older");
  {
    Journal journal(path_, kFacts, {});
    journal.Keep(FullRecording(9));
  }
  EXPECT_EQ(ReadJournal(path_).recording.control.size(), 9u);
}

TEST_F(JournalFile, IsWrittenByOneRunAtATimeAndReadByNobodyMeanwhile) {
  Journal first(path_, kFacts, [](const std::string& why) { ADD_FAILURE() << why; });
  first.Keep(FullRecording(9));
  WaitUntil([&] { return Size() > 0; });
  EXPECT_EQ(Refusal(path_), path_ + ": is being written just now: its run goes on");
  std::string complaint;
  std::atomic<bool> has_complained = false;
  {
    Journal second(path_, kFacts, [&](const std::string& why) {
      complaint = why;
      has_complained = true;
    });
    second.Keep(FullRecording(5));
    WaitUntil([&] { return has_complained.load(); });
  }
  EXPECT_EQ(complaint, path_ + ": another run is writing here just now");
}

TEST_F(JournalFile, ComplainsOnceOfADiskThatStaysFull) {
  fs::create_symlink("/dev/full", path_);
  const Recording whole = FullRecording(90);
  std::vector<std::string> complaints;
  std::atomic<std::size_t> num_complaints = 0;
  const auto complain = [&](const std::string& why) {
    complaints.push_back(why);
    num_complaints = complaints.size();
  };
  {
    Journal journal(path_, kFacts, complain);
    journal.Keep(Beginning(whole, 0.1));
    WaitUntil([&] { return num_complaints == 1; });
    journal.Keep(whole);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    EXPECT_FALSE(journal.Close());
  }
  ASSERT_EQ(complaints.size(), 1u);
  EXPECT_EQ(complaints[0], path_ + ": cannot be written: No space left on device");
}

// While it lives, no file may grow beyond `bytes`.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &usual_);
    const rlimit small = {bytes, usual_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &usual_); }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit usual_ = {};
};

TEST_F(JournalFile, GoesOnWhereItWasWhenThereIsRoomAgain) {
  const Recording whole = WithoutMetrics(FullRecording(900));
  std::atomic<int> complaints = 0;
  {
    Journal journal(path_, kFacts, [&](const std::string&) { ++complaints; });
    journal.Keep(Beginning(whole, 0.3));
    WaitUntil([&] { return Size() > 0; });
    const SmallDisk disk(Size() + 700);  // within the next part
    journal.Keep(Beginning(whole, 0.6));
    WaitUntil([&] { return complaints > 0; });
  }
  const JournalContents contents = ReadJournal(path_);
  EXPECT_EQ(contents.damage, "");
  EXPECT_EQ(ToHdf5(contents.recording), WithFacts(Beginning(whole, 0.6)));
  EXPECT_EQ(complaints, 1);
}

TEST_F(JournalFile, SaysWhatIsWrongWithAFileThatIsNone) {
  EXPECT_EQ(Refusal(path_), path_ + ": no such file");
  WriteBytes(path_, "");
  EXPECT_EQ(Refusal(path_), path_ + ": is empty");
  WriteRecording(FullRecording(9), path_);
  EXPECT_EQ(Refusal(path_), path_ + ": is not a sidestep journal file");
}

}  // namespace
}  // namespace sidestep::record
