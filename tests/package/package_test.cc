#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sidestep/planner/registry.h"
#include "sidestep/sdf/prediction/registry.h"
#include "tests/package/installation.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(Package, IsFoundBuiltAgainstAndRunByAnOutsideProject) {
  const Installation installation;
  ASSERT_EQ(installation.Install("command").exit_code, 0);
  ASSERT_EQ(installation.Install("development").exit_code, 0);
  const std::string build = (installation.folder() / "outside").string();
  const Finished configured =
      RunProgram({CMAKE_PROGRAM, "-S", SIDESTEP_SOURCE_DIR "/tests/package/outside", "-B", build,
                  "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_COMPILER=" CXX_COMPILER,
                  "-DCMAKE_C_COMPILER=" C_COMPILER, "-DCMAKE_CXX_FLAGS=" CXX_FLAGS,
                  "-DCMAKE_PREFIX_PATH=" + installation.prefix().string()});
  ASSERT_EQ(configured.exit_code, 0) << configured.out << configured.err;
  const Finished built = RunProgram({CMAKE_PROGRAM, "--build", build});
  ASSERT_EQ(built.exit_code, 0) << built.out << built.err;
  const Finished run = RunProgram({build + "/outside", build + "/libplug_in.so"}, {}, build);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("planning cycles"));
  // As many as this program knows, which is linked with the same libraries.
  const std::size_t known = planner::PlannerNames().size() + sdf::PredictorNames().size();
  EXPECT_THAT(run.out, HasSubstr(std::to_string(known) + " planners and predictors"));
}

TEST(Package, AsADebianOneRunsWhereItIsUnpacked) {
  ASSERT_TRUE(fs::exists("/usr/bin/dpkg-shlibdeps")) << "needs Debian's dpkg-dev";
  const Installation installation;
  const fs::path debs = installation.folder() / "debs";
  const Finished packed = RunProgram(
      {CPACK_PROGRAM, "--config", SIDESTEP_BUILD_DIR "/CPackConfig.cmake", "-B", debs.string()});
  ASSERT_EQ(packed.exit_code, 0) << packed.out << packed.err;
  fs::path command, development;
  for (const auto& entry : fs::directory_iterator(debs)) {
    if (entry.path().extension() != ".deb") continue;
    const bool is_command = entry.path().filename().string().rfind("sidestep_", 0) == 0;
    (is_command ? command : development) = entry.path();
  }
  ASSERT_FALSE(command.empty());
  ASSERT_FALSE(development.empty());
  const Finished fields = RunProgram({"/usr/bin/dpkg-deb", "--field", command.string(), "Depends"});
  for (const char* const library : {"libmujoco", "libhdf5", "libosmesa"}) {
    EXPECT_THAT(fields.out, HasSubstr(library));
  }

  const fs::path root = installation.folder() / "root";
  ASSERT_EQ(
      RunProgram({"/usr/bin/dpkg-deb", "--extract", command.string(), root.string()}).exit_code, 0);
  const Finished doctor = RunProgram({(root / "usr/bin/sidestep").string(), "doctor"}, {}, "/");
  EXPECT_EQ(doctor.exit_code, 0) << doctor.out << doctor.err;
  EXPECT_THAT(doctor.out, HasSubstr((root / "usr/share/sidestep/scenarios").string()));
  EXPECT_TRUE(fs::exists(root / "usr/share/man/man1/sidestep-run.1"));
  EXPECT_FALSE(fs::exists(root / "usr/include"));
}

TEST(Documentation, IsMadeWithoutAWarning) {
  ASSERT_TRUE(fs::exists("/usr/bin/doxygen")) << "needs doxygen";
  const Installation installation;
  const Finished made =
      RunProgram({"/usr/bin/doxygen", "docs/Doxyfile"},
                 {"SIDESTEP_DOCS_OUT=" + installation.folder().string()}, SIDESTEP_SOURCE_DIR);
  EXPECT_EQ(made.exit_code, 0) << made.out << made.err;
  EXPECT_EQ(made.err, "");
}

}  // namespace
}  // namespace sidestep
