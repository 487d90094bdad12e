#include "sidestep/core/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::atomic_file_test {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).native(); }
  static std::string Read(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t NumFiles() const {
    return std::distance(fs::directory_iterator(folder_.path()), {});
  }
  static std::string Complaint(const std::string& path) {
    try {
      WriteFile(path, "new");
    } catch (const InputError& error) {
      return error.what();
    }
    return "was written";
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(AtomicFileTest, AppearsWholeWhenItIsCommitted) {
  AtomicFile file(Path("a"));
  file.Append("0123456789");
  file.WriteAt(3, "xyz");
  file.WriteAt(12, "!");
  EXPECT_EQ(file.size(), 13u);
  char bytes[8] = {};
  EXPECT_EQ(file.ReadAt(2, bytes, 4), 4u);
  EXPECT_EQ(std::string(bytes), "2xyz");
  EXPECT_EQ(file.ReadAt(13, bytes, 4), 0u);
  EXPECT_FALSE(fs::exists(Path("a")));
  file.Commit();
  EXPECT_EQ(Read(Path("a")), std::string("012xyz6789\0\0!", 13));
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(AtomicFileTest, LeavesTheOldOneUntilThen) {
  WriteFile(Path("a"), "old");
  {
    AtomicFile file(Path("a"));
    file.Append("new");
    EXPECT_EQ(Read(Path("a")), "old");
  }
  CheckCanWrite(Path("a"));
  EXPECT_EQ(Read(Path("a")), "old");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(AtomicFileTest, MayBeNamedAnything) {
  for (const std::string name : {"plain", "2026-11-27T10:15:00", "http:x", "-", ".hidden",
                                 "caf\xC3\xA9", "caf\xE9", "a\nb", "%s", "\xFF\xFE"}) {
    WriteFile(Path(name), name);
    EXPECT_EQ(Read(Path(name)), name);
  }
  const std::string longest(255, 'x');
  WriteFile(Path(longest), "long");
  EXPECT_EQ(Read(Path(longest)), "long");
  EXPECT_EQ(NumFiles(), 11);
}

TEST_F(AtomicFileTest, InTheWorkingFolderNeedsNoFolderInItsName) {
  const fs::path before = fs::current_path();
  fs::current_path(Path("."));
  WriteFile("here", "text");
  fs::current_path(before);
  EXPECT_EQ(Read(Path("here")), "text");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(AtomicFileTest, KeepsWhoMayReadIt) {
  const mode_t before = umask(027);
  WriteFile(Path("new"), "1");
  WriteFile(Path("old"), "1");
  chmod(Path("old").c_str(), 0604);
  WriteFile(Path("old"), "2");
  umask(before);
  const auto mode = [](const std::string& path) {
    return static_cast<unsigned>(fs::status(path).permissions());
  };
  EXPECT_EQ(mode(Path("new")), 0640u);
  EXPECT_EQ(mode(Path("old")), 0604u);
}

TEST_F(AtomicFileTest, GoesWhereASymbolicLinkLeadsAndTheLinkStays) {
  fs::create_directory(Path("far"));
  fs::create_symlink("far/target", Path("link"));
  fs::create_symlink(Path("link"), Path("link_of_link"));
  WriteFile(Path("link_of_link"), "first");  // the target is not there yet
  EXPECT_EQ(Read(Path("far/target")), "first");
  WriteFile(Path("link"), "second");
  EXPECT_EQ(Read(Path("far/target")), "second");
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(NumFiles(), 3);
  fs::create_symlink("loop", Path("loop"));
  EXPECT_EQ(Complaint(Path("loop")),
            Path("loop") + ": cannot be written: Too many levels of symbolic links");
}

TEST_F(AtomicFileTest, IsWrittenIntoWhatIsNoRegularFile) {
  WriteFile("/dev/null", "nothing");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(Complaint("/dev/full"), "/dev/full: cannot be written: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));

  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  std::string heard;
  std::thread listener([&] { heard = Read(Path("pipe")); });
  WriteFile(Path("pipe"), "through the pipe");
  listener.join();
  EXPECT_EQ(heard, "through the pipe");
}

TEST_F(AtomicFileTest, GoesIntoAnOpenFileWhereItIs) {
  const int descriptor = open(Path("out").c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_EQ(write(descriptor, "before ", 7), 7);
  WriteFile("/dev/fd/" + std::to_string(descriptor), "file");
  ASSERT_EQ(write(descriptor, " after", 6), 6);
  close(descriptor);
  EXPECT_EQ(Read(Path("out")), "before file after");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(AtomicFileTest, ThatCannotBeIsRefusedAtOnceWithItsReasonAndLeavesNothing) {
  WriteFile(Path("file"), "");
  fs::create_directory(Path("folder"));
  const struct {
    std::string path, reason;
  } cases[] = {
      {"", "No such file or directory"},
      {Path("absent/a"), "No such file or directory"},
      {Path("file/a"), "Not a directory"},
      {Path("folder"), "Is a directory"},
      {Path("folder/"), "Is a directory"},
      {Path("absent/"), "Is a directory"},
      {Path(std::string(256, 'x')), "File name too long"},
      {"/proc/a", "No such file or directory"},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(Complaint(c.path), c.path + ": cannot be written: " + c.reason);
    EXPECT_THROW(CheckCanWrite(c.path), InputError) << c.path;
  }
  EXPECT_EQ(NumFiles(), 2);
  EXPECT_TRUE(fs::is_empty(Path("folder")));
}

TEST_F(AtomicFileTest, OfOneNameByManyIsThatOfOneOfThem) {
  std::vector<std::thread> writers;
  for (int n = 0; n < 8; ++n) {
    writers.emplace_back([&, n] {
      for (int i = 0; i < 20; ++i)
        WriteFile(Path("a"), std::string(100000, static_cast<char>('a' + n)));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string bytes = Read(Path("a"));
  EXPECT_EQ(bytes, std::string(100000, bytes.at(0)));
  EXPECT_EQ(NumFiles(), 1);
}

}  // namespace
}  // namespace sidestep::atomic_file_test
