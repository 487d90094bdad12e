#pragma once

#include <memory>
#include <string>

namespace sidestep::imports {

/// Keeps what urdfdom says from the console as long as it lives, which is where urdfdom says it.
class UrdfdomMessages {
 public:
  UrdfdomMessages();
  ~UrdfdomMessages();
  UrdfdomMessages(const UrdfdomMessages&) = delete;
  UrdfdomMessages& operator=(const UrdfdomMessages&) = delete;

  std::string text() const;  ///< errors so far, one after the other

 private:
  class Handler;
  std::unique_ptr<Handler> handler_;
};

}  // namespace sidestep::imports
