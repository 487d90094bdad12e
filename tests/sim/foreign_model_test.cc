#include "sidestep/sim/foreign_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/world_xml.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::foreign_model_test {
namespace {

std::string Times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

struct Refused {
  const char* name;
  std::string text;  // between <mujoco> and </mujoco>, from line 2 on
  const char* message;
};

class ForeignModel : public ::testing::TestWithParam<Refused> {};

// What MuJoCo would open, blow up, or allocate for without end.
TEST_P(ForeignModel, IsRefusedAtItsLine) {
  const std::string text = "<mujoco>\n" + GetParam().text + "</mujoco>";
  EXPECT_THAT([&] { LoadForeignModel(text, "t.h5: model_xml"); },
              testing::ThrowsMessage<InputError>(
                  testing::StartsWith(std::string("t.h5: model_xml") + GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    What, ForeignModel,
    ::testing::Values(
        Refused{"MeshFile", "<asset>\n<mesh file='a.stl'/></asset>", ":3: file: a model must not"},
        Refused{
            "MeshDetail",
            "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' scale='0 1 1'/></asset>",
            ":2: scale: is not taken: a mesh is given by its name and the vertices of its hull"},
        Refused{"MeshClass", "<default>\n<mesh scale='0 1 1'/></default>",
                ":3: scale: is not taken: a mesh is given by its name and"},
        Refused{"MeshNumber", "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 x'/></asset>",
                ":2: vertex: must be numbers, holds 'x'"},
        Refused{"MeshOfThree", "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0'/></asset>",
                ":2: vertex: must be three numbers each of four vertices or more, are 9"},
        Refused{"MeshCutOff", "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1 1'/></asset>",
                ":2: vertex: must be three numbers each of four vertices or more, are 13"},
        Refused{"MeshWithoutEnd",
                "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 inf'/></asset>",
                ":2: vertex: must be finite"},
        Refused{"MeshTooFar", "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1e15'/></asset>",
                ":2: vertex: must be within 100 m"},
        Refused{"MeshThatIsFlat",
                "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 1e-6'/></asset>",
                ":2: vertex: must span a solid, is flatter than 0.01 mm"},
        Refused{"MeshThatIsTiny",
                "<asset><mesh name='m' vertex='0 0 0 1e-6 0 0 0 1e-6 0 0 0 1e-6'/></asset>",
                ":2: vertex: must span a solid, is flatter than 0.01 mm"},
        Refused{"MeshOfManyVertices",
                "<asset><mesh name='m' vertex='" + Times(20001, "0 1 2 ") + "'/></asset>",
                ":2: vertex: with it meshes would have more than 20000 vertices"},
        Refused{"MeshWithFaces",
                "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 1 9'/></asset>",
                ":2: face: is not taken: a mesh is given by"},
        Refused{"Texture", "<asset><texture type='2d' file='/dev/zero'/></asset>",
                ":2: file: a model must not"},
        Refused{"Sky", "<asset><texture type='skybox' fileright='a.png'/></asset>",
                ":2: fileright: a model must not"},
        Refused{"HeightField",
                "<asset><hfield name='h' nrow='100000' ncol='100000' size='1 1 1 1'/>"
                "</asset>",
                ":2: hfield: is no part of a robot of ours"},
        Refused{"Skin", "<asset><skin name='s' file='s.skn'/></asset>",
                ":2: file: a model must not"},
        Refused{"Include", "<worldbody>\n<include file='b.xml'/></worldbody>",
                ":3: include: a model must not"},
        Refused{"Composite",
                "<worldbody><body><composite type='grid' count='1000 1000 1' spacing='1'>"
                "<geom size='.1'/></composite></body></worldbody>",
                ":2: composite: is no part of a robot of ours"},
        Refused{"Custom", "<custom><numeric name='n' size='2000000000'/></custom>",
                ":2: custom: is no section of a world of ours"},
        Refused{"Keyframe", "\n<keyframe/>", ":3: keyframe: is no section"},
        Refused{"Constraints", "<size njmax='1000000'/>",
                ":2: njmax: must be at most 8000, is 1000000"},
        Refused{"Stack", "<size nstack='2000000000'/>", ":2: nstack: must be at most 100"},
        Refused{"UserData", "<size nuserdata='2e9'/>", ":2: nuserdata: must be at most 100"},
        Refused{"OnePicture",
                "<asset><texture type='2d' builtin='flat' width='100000' height='10'/></asset>",
                ":2: width: must be at most 4096, is 100000"},
        Refused{"ManyPictures",
                "<asset>" +
                    Times(2, "\n<texture type='2d' builtin='flat' width='4000' height='4000'/>") +
                    "</asset>",
                ":3: texture: with it textures would take more than 256 MiB of memory"},
        Refused{"Screen", "<visual>\n<global offwidth='1000000'/></visual>",
                ":3: offwidth: must be at most 8192, is 1000000"},
        Refused{"Shadow", "<visual><quality shadowsize='1000000'/></visual>",
                ":2: shadowsize: must be at most 16384"},
        Refused{"Sensor", "<sensor><user dim='1000000000'/></sensor>",
                ":2: dim: must be at most 1000"},
        Refused{"Joints", "<worldbody><body>" + Times(257, "<joint/>\n") + "</body></worldbody>",
                ":258: joint: is one joint too many, of at most 256"},
        Refused{"Elements", "<worldbody>" + Times(5000, "<site/>") + "</worldbody>",
                ":2: site: is one element too many, of at most 5000"},
        Refused{"Bytes", Times(100000, "<!-- a long tale ... -->"),
                ": is 2400018 bytes long, must be at most 2097152"},
        Refused{"Depth", Times(1000, "<body>") + Times(1000, "</body>"),
                ":2: is no well-formed XML: element depth exceeded"},
        Refused{"Syntax", "<worldbody>", ":2: is no well-formed XML: mismatched element"},
        Refused{"Meaning", "<worldbody><geom size='1' material='gold'/></worldbody>",
                ":2: material 'gold' not found"}),
    [](const auto& test) { return test.param.name; });

TEST(ForeignModelText, MustBeMjcf) {
  EXPECT_THAT([] { LoadForeignModel("<robot/>", "t.h5: model_xml"); },
              testing::ThrowsMessage<InputError>(
                  "t.h5: model_xml:1: must be an MJCF file, whose root is <mujoco>"));
}

TEST(ForeignModelText, MayBeAnyWorldThatWeWrite) {
  const scenarios::Scenario scenario = TwoLinkScenario();
  EXPECT_NE(LoadForeignModel(BuildWorldXml(scenario, {}, kTestModels), "t.h5"), nullptr);
}

}  // namespace
}  // namespace sidestep::sim::foreign_model_test
