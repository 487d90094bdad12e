#include "sidestep/sim/fci/frame_server.h"

#include <utility>

namespace sidestep::sim::fci {

using robot::fci::FrameQuestion;

FrameServer::FrameServer(const std::string& address, const World& world, MakeCamera make_camera)
    : world_(world),
      make_camera_(std::move(make_camera)),
      listener_(address, robot::fci::kFramePort) {}

std::vector<int> FrameServer::descriptors() const {
  std::vector<int> descriptors = {listener_.fd()};
  if (viewer_) descriptors.push_back(viewer_->stream.fd());
  return descriptors;
}

void FrameServer::Answer() {
  if (viewer_) {
    try {
      AnswerViewer();
    } catch (const robot::fci::LinkError&) {  // it has gone
      viewer_.reset();
    }
  }
  while (auto stream = listener_.Accept()) {
    if (!viewer_) viewer_.emplace(Viewer{std::move(*stream), make_camera_()});
  }
}

void FrameServer::AnswerViewer() {
  robot::fci::Bytes questions;
  while (viewer_->stream.Receive(&questions)) {
  }
  for (const std::uint8_t question : questions) {
    robot::fci::FrameReply reply;
    if (question == static_cast<std::uint8_t>(FrameQuestion::kRead)) {
      reply.frame = viewer_->camera->Read(world_.time());
    } else if (question != static_cast<std::uint8_t>(FrameQuestion::kWhen)) {
      throw robot::fci::LinkError("the viewer asks something else");
    }
    reply.next_due = viewer_->camera->NextDue();
    viewer_->stream.Send(Encode(reply));
  }
}

}  // namespace sidestep::sim::fci
