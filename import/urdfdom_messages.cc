#include "sidestep/import/urdfdom_messages.h"

#include <console_bridge/console.h>

namespace sidestep::imports {

class UrdfdomMessages::Handler final : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    text_ += (text_.empty() ? "" : " ") + text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

UrdfdomMessages::UrdfdomMessages() : handler_(std::make_unique<Handler>()) {
  console_bridge::useOutputHandler(handler_.get());
}

UrdfdomMessages::~UrdfdomMessages() { console_bridge::restorePreviousOutputHandler(); }

std::string UrdfdomMessages::text() const { return handler_->text(); }

}  // namespace sidestep::imports
