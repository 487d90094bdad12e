#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace sidestep {

/// A real browser, Debian's Chromium, without a display, drawing by software. It speaks the
/// DevTools protocol through a pipe. Every method throws std::runtime_error if it has died or says
/// no.
class Browser {
 public:
  /// Whether there is one on this machine; says so on the standard error if not.
  static bool IsInstalled();

  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// The page's picture, before it is opened. @param mobile as a phone shows it, touch included.
  void Resize(int width, int height, bool mobile = false);
  void PreferDark(bool dark);
  /// Opens a file, with what follows `#` in its address, and waits until it has loaded.
  void Open(const std::string& path, const std::string& hash = "");
  /// What an expression gives; promises are waited for.
  nlohmann::json Evaluate(const std::string& expression);
  /// A key as a person presses it: "a", " ", "ArrowLeft".
  void Press(const std::string& key);
  /// A finger put down at `x, y`, drawn so far, and lifted [CSS pixels].
  void Swipe(double x, double y, double dx, double dy);
  /// What went wrong since the page was opened: messages of the console, exceptions, and
  /// everything that the page asked the network for.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  nlohmann::json Call(const std::string& method,
                      const nlohmann::json& parameters = nlohmann::json::object());
  nlohmann::json Receive();
  void Go(const std::string& url);
  void Note(const nlohmann::json& event);

  TemporaryFolder profile_;
  int child_ = -1, to_ = -1, from_ = -1;
  std::string received_, session_;
  int last_id_ = 0;
  std::set<std::string> loaded_;  // documents, by their loaders
  std::vector<std::string> complaints_;
};

}  // namespace sidestep
