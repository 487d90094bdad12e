#include "sidestep/bench/validation/faults.h"

#include "sidestep/bench/validation/named_row.h"

namespace sidestep::bench {
namespace {

const ValidationFault kFaults[] = {
    {.name = "none"},
    {.name = "no_scans",
     .sensor = {.blind_from_s = 2, .blind_for_s = 1e9},
     .expected = "perception_stale hold"},
    {.name = "obstacle_unseen", .sensor = {.lost_from_s = 2}, .expected = "obstacle_lost hold"},
    {.name = "future_stamps",
     .sensor = {.ahead_from_s = 2, .ahead_s = 0.3},
     .expected = "time_stamps hold|perception_stale hold"},
    {.name = "lost_in_a_row",
     .on_the_wire = "{kind: lose_commands, at_s: 2, count: 15}",
     .expected = "link hold",
     .may_go_on = true},
    {.name = "lost_too_many",
     .on_the_wire = "{kind: lose_commands, at_s: 2, count: 25}",
     .expected = "communication_constraints_violation"},
    {.name = "user_stop",
     .on_the_wire = "{kind: user_stop, at_s: 2, for_s: 0.5}",
     .expected = "the user stop is pressed"},
    {.name = "guiding",
     .on_the_wire = "{kind: guiding, at_s: 2, for_s: 0.5}",
     .expected = "the motion was aborted"},
    {.name = "reflex",
     .on_the_wire = "{kind: error, at_s: 2, name: cartesian_reflex}",
     .expected = "cartesian_reflex"},
    {.name = "cut_link", .on_the_wire = "{kind: cut_link, at_s: 2}", .expected = "connection"},
    {.name = "pushed",
     .on_the_wire = "{kind: external_torque, at_s: 2, for_s: 1, joint: 7, rate_n_m_s: 30}",
     .expected = "external_torque brake|joint_reflex|cartesian_reflex"},
    {.name = "blocked_joint",
     .on_the_wire = "{kind: blocked_joint, at_s: 2, for_s: 5, joint: 1}",
     .expected = "tracking brake|external_torque brake|joint_reflex|cartesian_reflex"},
    {.name = "tracking_offset",
     .on_the_wire = "{kind: tracking_offset, at_s: 2, for_s: 5, joint: 4, offset_rad: 0.05}",
     .expected = "tracking brake|external_torque brake|joint_reflex|cartesian_reflex"},
};

}  // namespace

std::span<const ValidationFault> ValidationFaults() { return kFaults; }

const ValidationFault& ValidationFaultOf(const std::string& name) {
  return RowNamed(ValidationFaults(), "fault", name);
}

}  // namespace sidestep::bench
