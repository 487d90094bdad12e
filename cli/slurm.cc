#include "sidestep/cli/slurm.h"

#include <sys/wait.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <sstream>

#include "sidestep/cli/console.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {
namespace {

constexpr int kDefaultMaxArraySize = 1001;
constexpr int kNotFound = 127;  // the shell's exit code

}  // namespace

std::vector<SlurmArray> DivideIntoArrays(const std::vector<int>& shards, int max_array_size) {
  std::vector<SlurmArray> arrays;
  const int most = max_array_size - 1;  // indices from 1 on
  for (const int shard : shards) {
    const int offset = (shard - 1) / most * most;
    if (arrays.empty() || arrays.back().offset != offset) arrays.push_back({offset, {}});
    arrays.back().indices.push_back(shard - offset);
  }
  return arrays;
}

std::string ArrayText(const std::vector<int>& indices) {
  std::string text;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(indices[i]);
    if (last > i) text += "-" + std::to_string(indices[last]);
    i = last + 1;
  }
  return text;
}

std::vector<std::string> SbatchCommand(const SlurmRequest& request, const std::string& name,
                                       const std::string& log, const std::vector<int>& indices,
                                       int throttle, const std::vector<std::string>& after,
                                       const std::string& script,
                                       const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"sbatch", "--parsable", "--job-name=" + name, "--output=" + log,
                                    "--cpus-per-task=" + std::to_string(request.cpus)};
  if (!indices.empty()) {
    words.push_back("--array=" + ArrayText(indices) +
                    (throttle > 0 ? "%" + std::to_string(throttle) : ""));
    // A minute before its time is up, so that what is in flight is finished.
    words.push_back("--signal=B:TERM@60");
  }
  if (!after.empty()) words.push_back("--dependency=afterany:" + Joined(after, ":"));
  if (!request.time.empty()) words.push_back("--time=" + request.time);
  if (!request.partition.empty()) words.push_back("--partition=" + request.partition);
  if (!request.account.empty()) words.push_back("--account=" + request.account);
  words.insert(words.end(), request.more.begin(), request.more.end());
  words.push_back(script);
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

std::string RunSlurm(const std::vector<std::string>& words) {
  const std::string command =
      Joined(words, " ", [](const std::string& word) { return ShellQuoted(word); });
  std::FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw InputError(words.front(), "cannot be started");
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t length = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.append(buffer.data(), length);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) {
    throw InputError(words.front(),
                     "there is no such program here: is this a machine of the cluster?");
  }
  if (status != 0) throw InputError(words.front(), OneLine(text));
  return text;
}

int MaxArraySizeIn(const std::string& config) {
  std::istringstream lines(config);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (line.rfind("MaxArraySize", 0) != 0 || equals == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(' ', equals + 1);
    int size = 0;
    const char* const end = line.data() + line.size();
    if (begin == std::string::npos) break;
    if (std::from_chars(line.data() + begin, end, size).ec == std::errc() && size > 1) return size;
  }
  return kDefaultMaxArraySize;
}

std::map<std::string, int> StatesIn(const std::string& queue) {
  std::map<std::string, int> states;
  std::istringstream lines(queue);
  for (std::string state; lines >> state;) ++states[state];
  return states;
}

}  // namespace sidestep::cli
