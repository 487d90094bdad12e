#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace sidestep::cli {

/// The commands of a program or a command, in the order of --help; hidden ones (of no group) are
/// left out.
inline std::vector<const CLI::App*> Commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// The names of an option as they are typed: -j, --jobs. Empty for a positional one.
inline std::vector<std::string> Flags(const CLI::Option& option) {
  std::vector<std::string> flags;
  for (const std::string& name : option.get_snames()) flags.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  return flags;
}

/// Whether a word must follow the option.
inline bool TakesValue(const CLI::Option& option) { return option.get_items_expected_min() > 0; }

}  // namespace sidestep::cli
