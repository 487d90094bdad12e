#include <string>

#include "sidestep/bench/report/gnuplot.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/reproduce.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {

std::optional<bench::CsvTable> ReadPublished(const std::string& path,
                                             const std::vector<std::string>& columns) {
  if (path.empty()) return std::nullopt;
  return bench::CsvTable::Read(path, columns);
}

std::string DrawInto(const std::string& folder, const std::string& name,
                     const bench::Figure& figure) {
  const std::string stem = folder + "/" + name;
  if (!bench::DrawFigure(figure, stem)) {
    Print("not drawn: {}.svg, {}.png: gnuplot is missing or failed ({})\n", stem, stem,
          bench::kGnuplotRemedy);
    return "";
  }
  Print("written: {}.svg, {}.png\n", stem, stem);
  return stem + ".svg";
}

void AddReproduceCommand(CommandLine& line) {
  CLI::App* const reproduce = line.app.add_subcommand(
      "reproduce", "Run an experiment of Finean, Merkt & Havoutis (ICAPS 2021) as published");
  // Not required of CLI11, whose complaint would not name the word that was wrong.
  reproduce->require_subcommand(0, 1);
  reproduce->callback([reproduce] {
    if (!reproduce->get_subcommands().empty()) return;
    const auto name = [](const CLI::App* experiment) { return experiment->get_name(); };
    throw InputError("reproduce",
                     "needs one of " + Joined(reproduce->get_subcommands({}), ", ", name));
  });
  AddReproduceOpenLoop(line, *reproduce);
  AddReproduceSdfTiming(line, *reproduce);
  AddReproduceClosedLoop(line, *reproduce);
}

}  // namespace sidestep::cli
