#include "sidestep/cli/man_page.h"

#include <algorithm>
#include <cctype>

#include "sidestep/cli/command_tree.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {
namespace {

// Text as roff takes it literally.
std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    const bool begins_a_line = escaped.empty() || escaped.back() == '\n';
    if (begins_a_line && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Bold(const std::string& text) { return "\\fB" + Escape(text) + "\\fR"; }
std::string Italic(const std::string& text) { return "\\fI" + Escape(text) + "\\fR"; }

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string Argument(const CLI::Option& option) {
  const std::string name = Italic(option.get_name(/*positional=*/true));
  return option.get_expected_max() > 1 ? name + " ..." : name;
}

std::string Synopsis(const std::string& call, const CLI::App& command) {
  std::string text = Bold(call);
  if (!Commands(command).empty()) return text + " " + Italic("COMMAND") + " ...\n";
  text += " [" + Italic("OPTION") + " ...]";
  for (const CLI::Option* const option : command.get_options()) {
    if (!option->get_positional()) continue;
    text += option->get_required() ? " " + Argument(*option) : " [" + Argument(*option) + "]";
  }
  return text + "\n";
}

std::string Entry(const std::string& head, const std::string& text) {
  return ".TP\n" + head + "\n" + Escape(text) + "\n";
}

std::string OptionsOf(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* const option : command.get_options()) {
    if (option->get_positional()) {
      text += Entry(Argument(*option), option->get_description());
      continue;
    }
    std::string names = Joined(Flags(*option), ", ", &Bold);
    if (TakesValue(*option)) names += " " + Italic(option->get_type_name());
    text += Entry(names, option->get_description());
  }
  return text;
}

std::string PageName(const std::string& call) {
  std::string name = call;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string Page(const std::string& call, const CLI::App& command, const CLI::App& program,
                 const std::string& version) {
  const bool is_program = &command == &program;
  std::string text =
      ".TH " + Escape(Upper(PageName(call))) + " 1 \"\" \"" + Escape(version) + "\" \"Sidestep\"\n";
  text +=
      ".SH NAME\n" + Escape(PageName(call)) + " \\- " + Escape(command.get_description()) + "\n";
  text += ".SH SYNOPSIS\n" + Synopsis(call, command);
  const std::vector<const CLI::App*> commands = Commands(command);
  if (!commands.empty()) text += ".SH COMMANDS\n";
  for (const CLI::App* const inner : commands) {
    text += Entry(Bold(inner->get_name()), inner->get_description());
  }
  text += ".SH OPTIONS\n" + OptionsOf(command);
  if (!is_program) {
    for (const CLI::App* const inner : commands) {
      text += ".SH \"" + Escape(Upper(inner->get_name())) + "\"\n" +
              Synopsis(call + " " + inner->get_name(), *inner) + OptionsOf(*inner);
    }
  }
  for (const CLI::App* const with_footer : {&command, is_program ? nullptr : &program}) {
    if (with_footer == nullptr || with_footer->get_footer().empty()) continue;
    text += ".SH NOTES\n.nf\n" + Escape(with_footer->get_footer()) + "\n.fi\n";
  }
  text += ".SH SEE ALSO\n";
  if (!is_program) return text + Bold(program.get_name()) + "(1)\n";
  const auto page = [&](const CLI::App* inner) {
    return Bold(PageName(call + " " + inner->get_name())) + "(1)";
  };
  return text + Joined(commands, ",\n", page) + "\n";
}

}  // namespace

std::map<std::string, std::string> ManPages(const CLI::App& program, const std::string& version) {
  std::map<std::string, std::string> pages;
  const std::string& name = program.get_name();
  pages[PageName(name) + ".1"] = Page(name, program, program, version);
  for (const CLI::App* const command : Commands(program)) {
    const std::string call = name + " " + command->get_name();
    pages[PageName(call) + ".1"] = Page(call, *command, program, version);
  }
  return pages;
}

}  // namespace sidestep::cli
