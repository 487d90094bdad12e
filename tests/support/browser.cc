#include "tests/support/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr const char* kProgram = "/usr/bin/chromium";
constexpr int kPatience_ms = 60000;  // software draws, beside other tests

// Where a browser expects its pipes.
constexpr int kBrowserReads = 3, kBrowserWrites = 4;

}  // namespace

bool Browser::IsInstalled() {
  if (std::filesystem::exists(kProgram)) return true;
  std::cerr << "chromium is not installed: pages are not opened in a browser\n";
  return false;
}

Browser::Browser() {
  int to_browser[2], from_browser[2];
  if (pipe2(to_browser, O_CLOEXEC) != 0 || pipe2(from_browser, O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  const std::string profile = "--user-data-dir=" + profile_.path().string();
  const char* const arguments[] = {kProgram,
                                   "--headless",
                                   "--no-sandbox",
                                   "--remote-debugging-pipe",
                                   profile.c_str(),
                                   "--use-gl=angle",
                                   "--use-angle=swiftshader",
                                   "--enable-unsafe-swiftshader",
                                   "--no-first-run",
                                   "--hide-scrollbars",
                                   nullptr};
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("cannot fork");
  if (child_ == 0) {
    setpgid(0, 0);
    // Out of the way of the two numbers first.
    const int in = fcntl(to_browser[0], F_DUPFD, 10), out = fcntl(from_browser[1], F_DUPFD, 10);
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDIN_FILENO);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    dup2(in, kBrowserReads);
    dup2(out, kBrowserWrites);
    execv(kProgram, const_cast<char**>(arguments));
    _exit(127);
  }
  close(to_browser[0]);
  close(from_browser[1]);
  to_ = to_browser[1];
  from_ = from_browser[0];
  const nlohmann::json target = Call("Target.createTarget", {{"url", "about:blank"}});
  session_ = Call("Target.attachToTarget",
                  {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
  for (const char* const domain : {"Page", "Runtime", "Log", "Network"}) {
    Call(std::string(domain) + ".enable");
  }
  Call("Page.setLifecycleEventsEnabled", {{"enabled", true}});
}

Browser::~Browser() {
  close(to_);
  close(from_);
  kill(-child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

nlohmann::json Browser::Receive() {
  while (true) {
    const std::size_t end = received_.find('\0');
    if (end != std::string::npos) {
      nlohmann::json message = nlohmann::json::parse(received_.substr(0, end));
      received_.erase(0, end + 1);
      return message;
    }
    pollfd waiting = {from_, POLLIN, 0};
    if (poll(&waiting, 1, kPatience_ms) != 1) throw std::runtime_error("the browser says nothing");
    char bytes[65536];
    const ssize_t count = read(from_, bytes, sizeof bytes);
    if (count <= 0) throw std::runtime_error("the browser has ended");
    received_.append(bytes, static_cast<std::size_t>(count));
  }
}

nlohmann::json Browser::Call(const std::string& method, const nlohmann::json& parameters) {
  nlohmann::json message = {{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string bytes = message.dump() + '\0';
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = write(to_, bytes.data() + sent, bytes.size() - sent);
    if (count <= 0) throw std::runtime_error("the browser has ended");
    sent += static_cast<std::size_t>(count);
  }
  while (true) {
    const nlohmann::json answer = Receive();
    if (!answer.contains("id")) {
      Note(answer);
    } else if (answer["id"] == last_id_) {
      if (answer.contains("error"))
        throw std::runtime_error(method + ": " + answer["error"].dump());
      return answer["result"];
    }
  }
}

void Browser::Note(const nlohmann::json& event) {
  const std::string method = event["method"];
  if (method == "Page.lifecycleEvent" && event["params"]["name"] == "load") {
    loaded_.insert(event["params"]["loaderId"].get<std::string>());
  }
  if (method == "Runtime.exceptionThrown" || method == "Log.entryAdded" ||
      method == "Runtime.consoleAPICalled") {
    complaints_.push_back(event["params"].dump());
  }
  if (method == "Network.requestWillBeSent") {
    const std::string url = event["params"]["request"]["url"];
    if (!url.starts_with("file:") && !url.starts_with("data:"))
      complaints_.push_back("asks for " + url);
  }
}

void Browser::Resize(int width, int height, bool mobile) {
  Call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", mobile}});
  Call("Emulation.setTouchEmulationEnabled", {{"enabled", mobile}});
}

void Browser::PreferDark(bool dark) {
  Call("Emulation.setEmulatedMedia",
       {{"features", {{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}}}}});
}

void Browser::Open(const std::string& path, const std::string& hash) {
  Go("about:blank");  // else another hash of the same page is no new page
  complaints_.clear();
  Go("file://" + path + (hash.empty() ? "" : "#" + hash));
}

void Browser::Go(const std::string& url) {
  const std::string loader = Call("Page.navigate", {{"url", url}})["loaderId"];
  while (!loaded_.contains(loader)) Note(Receive());
}

nlohmann::json Browser::Evaluate(const std::string& expression) {
  const nlohmann::json answer =
      Call("Runtime.evaluate",
           {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails")) {
    throw std::runtime_error(expression + ": " + answer["exceptionDetails"].dump());
  }
  return answer["result"].value("value", nlohmann::json());
}

void Browser::Press(const std::string& key) {
  nlohmann::json parameters = {{"type", "keyDown"}, {"key", key}};
  if (key.size() == 1) parameters["text"] = key;
  Call("Input.dispatchKeyEvent", parameters);
  Call("Input.dispatchKeyEvent", {{"type", "keyUp"}, {"key", key}});
}

void Browser::Swipe(double x, double y, double dx, double dy) {
  const auto touch = [&](const char* type, const nlohmann::json& points) {
    Call("Input.dispatchTouchEvent", {{"type", type}, {"touchPoints", points}});
  };
  touch("touchStart", {{{"x", x}, {"y", y}}});
  for (int step = 1; step <= 5; ++step) {
    touch("touchMove", {{{"x", x + dx * step / 5}, {"y", y + dy * step / 5}}});
  }
  touch("touchEnd", nlohmann::json::array());
}

}  // namespace sidestep
