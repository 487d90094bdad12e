#include "sidestep/cli/bash_completion.h"

#include <array>

#include "sidestep/cli/command_tree.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {
namespace {

// Words for which `sidestep list KIND --names` knows the values.
struct Listed {
  const char* word;
  const char* kind;
};
constexpr std::array kListed = {Listed{"SCENARIO", "scenarios"}, Listed{"--knowledge", "knowledge"},
                                Listed{"--case", "knowledge"}, Listed{"--predictor", "predictors"},
                                Listed{"--planner", "planners"}};

// The list of values that `name` takes, as a command in the script; empty if they are free.
std::string ValuesOf(const std::string& name) {
  for (const Listed& listed : kListed) {
    if (name == listed.word)
      return std::string("$(\"$program\" list ") + listed.kind + " --names 2>/dev/null)";
  }
  return "";
}

// The branch of the script's `case` for one command, and those of its own commands.
std::string Branches(const std::string& call, const CLI::App& command) {
  std::vector<std::string> words, files;
  std::string values;
  for (const CLI::App* const inner : Commands(command)) words.push_back(inner->get_name());
  for (const CLI::Option* const option : command.get_options()) {
    if (option->get_positional()) {
      const std::string list = ValuesOf(option->get_name(/*positional=*/true));
      if (!list.empty()) words.push_back(list);
      continue;
    }
    const std::vector<std::string> flags = Flags(*option);
    words.insert(words.end(), flags.begin(), flags.end());
    if (!TakesValue(*option)) continue;
    const std::string list = ValuesOf(
        "--" + (option->get_lnames().empty() ? std::string() : option->get_lnames().front()));
    values += "        " + Joined(flags, "|") + ") words=\"" + list + "\" ;;\n";
  }
  std::string text = "    \"" + call + "\")\n      case \"$previous\" in\n" + values +
                     "        *) words=\"" + Joined(words, " ") + "\" ;;\n      esac\n      ;;\n";
  for (const CLI::App* const inner : Commands(command)) {
    text += Branches(call + " " + inner->get_name(), *inner);
  }
  return text;
}

// How many words of the line may name commands.
int Depth(const CLI::App& app) {
  int deepest = 0;
  for (const CLI::App* const inner : Commands(app)) deepest = std::max(deepest, 1 + Depth(*inner));
  return deepest;
}

std::string Calls(const std::string& call, const CLI::App& app) {
  std::string text;
  for (const CLI::App* const inner : Commands(app)) {
    const std::string longer = call + " " + inner->get_name();
    text += (text.empty() ? "\"" : "|\"") + longer + "\"";
    const std::string deeper = Calls(longer, *inner);
    if (!deeper.empty()) text += "|" + deeper;
  }
  return text;
}

}  // namespace

std::string BashCompletion(const CLI::App& program) {
  const std::string& name = program.get_name();
  return "# Completes the words of `" + name + "` in bash; made from its --help.\n_" + name +
         "() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local program=${COMP_WORDS[0]} call=" +
         name +
         " words=\"\" i\n"
         "  for ((i = 1; i < COMP_CWORD && i <= " +
         std::to_string(Depth(program)) +
         "; ++i)); do\n"
         "    case \"$call ${COMP_WORDS[i]}\" in\n      " +
         Calls(name, program) +
         ") call+=\" ${COMP_WORDS[i]}\" ;;\n"
         "      *) break ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$call\" in\n" +
         Branches(name, program) +
         "  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
         "}\n"
         "complete -o bashdefault -o default -F _" +
         name + " " + name + "\n";
}

}  // namespace sidestep::cli
