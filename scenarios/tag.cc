#include "sidestep/scenarios/tag.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <stdexcept>

#include "sidestep/core/joined.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

// The 6 x 6 data modules of each tag, row by row from the highest of 36 bits; 1 is white.
constexpr std::uint64_t kCodes[kNumTagIds] = {
    0xd5d628584, 0xd97f18b49, 0xdd280910e, 0xe479e9c98, 0xebcbca822, 0xf31dab3ac, 0x056a5d085,
    0x10652e1d4, 0x22b1dfead, 0x265ad0472, 0x34fe91b86, 0x3ff962cd5, 0x43a25329a, 0x474b4385f,
    0x4e9d243e9, 0x5246149ae, 0x5997f5538, 0x683bb6c4c, 0x6be4a7211, 0x7e3158eea, 0x81da494af,
    0x858339a74, 0x8cd51a5fe, 0x9f21cc2d7, 0xa2cabc89c, 0xadc58d9eb, 0xb16e7dfb0, 0xb8c05eb3a,
    0xd25ef139d, 0xd607e1962, 0xe4aba3076, 0x2dde6a3da, 0x43d40c678, 0x5620be351, 0x64c47fa65,
    0x686d7002a, 0x6c16605ef, 0x6fbf50bb4, 0x8d06d39dc, 0x9f53856b5, 0xadf746dc9, 0xbc9b084dd,
    0xd290aa77b, 0xd9e28b305, 0xe4dd5c454, 0xfad2fe6f2, 0x181a8151a, 0x26be42c2e, 0x2e10237b8,
    0x405cd5491, 0x7742eab1c, 0x85e6ac230, 0x8d388cdba, 0x9f853ea93, 0xc41ea2445, 0xcf1973594,
    0x14a34a333, 0x31eacd15b, 0x6c79d2dab, 0x73cbb3935, 0x89c155bd3, 0x8d6a46198, 0x91133675d,
    0xa708d89fb,
};

struct Axes {
  Eigen::Vector3d outward, up;
};

Axes AxesOf(const std::string& face) {
  for (std::size_t i = 0; i < std::size(kBoxFaces); ++i) {
    if (face != kBoxFaces[i]) continue;
    const auto axis = static_cast<Eigen::Index>(i / 2);
    return {(i % 2 == 0 ? 1 : -1) * Eigen::Vector3d::Unit(axis),
            axis == 2 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ()};
  }
  throw std::invalid_argument("a box has no face '" + face + "'");
}

// The shorter edge of a face.
double RoomOn(const Eigen::Vector3d& box_size_m, const std::string& face) {
  Eigen::Vector3d edges_m = box_size_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (AxesOf(face).outward(axis) != 0) edges_m(axis) = box_size_m.maxCoeff();
  }
  return edges_m.minCoeff();
}

}  // namespace

Pose TagPose(const Eigen::Vector3d& box_size_m, const std::string& face) {
  const Axes axes = AxesOf(face);
  Eigen::Matrix3d R_OT;
  R_OT.col(2) = -axes.outward;
  R_OT.col(1) = -axes.up;
  R_OT.col(0) = R_OT.col(1).cross(R_OT.col(2));
  const double out_m = axes.outward.cwiseAbs().dot(box_size_m) / 2 + kTagPaper_m;
  return {Eigen::Quaterniond(R_OT), out_m * axes.outward};
}

std::array<bool, kTagModules * kTagModules> BlackModules(int id) {
  if (id < 0 || id >= kNumTagIds) {
    throw std::invalid_argument("no tag has the id " + std::to_string(id));
  }
  const std::uint64_t code = kCodes[id];
  std::array<bool, kTagModules* kTagModules> black = {};
  for (int y = 0; y < kTagModules; ++y) {
    for (int x = 0; x < kTagModules; ++x) {
      const int rim = std::min({x, y, kTagModules - 1 - x, kTagModules - 1 - y});
      const int bit = 35 - (6 * (y - 2) + (x - 2));
      const bool is_black = rim == 1 || (rim > 1 && (code >> bit & 1) == 0);
      const int module = kTagModules * y + x;
      black[static_cast<std::size_t>(module)] = is_black;
    }
  }
  return black;
}

std::vector<Tag> ReadTags(const YamlReader& box, const Eigen::Vector3d& box_size_m) {
  std::vector<Tag> tags;
  if (!box.Has("tags")) return tags;
  std::set<std::string> faces;
  for (const YamlReader& map : box.GetMaps("tags")) {
    Tag tag;
    tag.face = map.GetChoice("face", {std::begin(kBoxFaces), std::end(kBoxFaces)});
    if (!faces.insert(tag.face).second) map.Fail("face", "bears a tag already");
    tag.id = map.GetInt("id");
    if (tag.id < 0 || tag.id >= kNumTagIds) {
      map.Fail("id", "must be from 0 to " + std::to_string(kNumTagIds - 1) + ", is " +
                         std::to_string(tag.id));
    }
    tag.size_m = map.GetPositive("size_m");
    const double room_m = RoomOn(box_size_m, tag.face);
    if (kTagPrint * tag.size_m > room_m * (1 + 1e-9)) {
      map.Fail("size_m", "with its white rim, a quarter more, it is wider than the face, " +
                             Number(room_m) + " m");
    }
    map.CheckNoUnknownKeys();
    tags.push_back(tag);
  }
  return tags;
}

std::string ToYaml(const std::vector<Tag>& tags) {
  return "[" +
         Joined(tags, ", ",
                [](const Tag& tag) {
                  return "{face: " + Quoted(tag.face) + ", id: " + std::to_string(tag.id) +
                         ", size_m: " + Number(tag.size_m) + "}";
                }) +
         "]";
}

}  // namespace sidestep::scenarios
