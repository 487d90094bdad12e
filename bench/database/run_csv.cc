#include "sidestep/bench/database/run_csv.h"

#include <vector>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr int kRowsAtOnce = 1000;

}  // namespace

void WriteRunCsv(const RunDatabase& database, const std::string& path) {
  AtomicFile file(path);
  const std::size_t head = CsvWriter(database.columns()).text().size();
  file.Append(CsvWriter(database.columns()).text());
  SqlStatement rows = database.Select("*");
  for (bool is_more = true; is_more;) {
    CsvWriter csv(database.columns());
    for (int i = 0; i < kRowsAtOnce && (is_more = rows.Step()); ++i) {
      std::vector<std::string> fields;
      for (int c = 0; c < rows.num_columns(); ++c) {
        fields.push_back(rows.Kind(c) == 'r' ? ShortestText(rows.Number(c)) : rows.Text(c));
      }
      csv.AddRow(fields);
    }
    file.Append(std::string_view(csv.text()).substr(head));
  }
  file.Commit();
}

}  // namespace sidestep::bench
