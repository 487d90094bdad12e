#include "sidestep/hardware/look_log.h"

#include <filesystem>
#include <vector>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::hardware {
namespace {

std::string TextOf(const std::vector<double>& values) { return Joined(values, " ", &ShortestText); }

std::string ValuesOf(const TagDetection& tag) {
  std::vector<double> values = {static_cast<double>(tag.hamming), tag.margin};
  for (const double px : tag.corners_px.reshaped()) values.push_back(px);
  return TextOf(values);
}

std::string ValuesOf(const ObjectObservation& body) {
  const Eigen::Vector3d& p = body.X_WO.translation();
  const Eigen::Quaterniond& q = body.X_WO.rotation();
  std::vector<double> values = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = row; column < 6; ++column) {
      values.push_back(body.covariance(row, column));
    }
  }
  return TextOf(values);
}

}  // namespace

void LookTable::Add(const Look& look) {
  const std::string number = std::to_string(look.frame.number);
  for (const TagDetection& tag : look.tags) {
    table_.AddRow({number, "tag", std::to_string(tag.id), ValuesOf(tag)});
  }
  for (const ObjectObservation& body : look.scan.objects) {
    table_.AddRow({number, "body", body.id, ValuesOf(body)});
  }
}

LookLog::LookLog(const std::string& folder) : folder_(folder), frames_(folder) {}

void LookLog::Add(const Look& look) {
  frames_.Add(look.frame);
  table_.Add(look);
  ++num_frames_;
}

void LookLog::Finish() {
  if (num_frames_ == 0) return;
  frames_.Finish();
  WriteFile((std::filesystem::path(folder_) / kTableFile).string(), table_.text());
}

}  // namespace sidestep::hardware
