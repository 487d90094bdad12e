#include "sidestep/core/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep::csv_test {
namespace {

using Fields = std::vector<std::string>;

TEST(CsvWriter, QuotesOnlyWhatItMust) {
  CsvWriter csv({"plain", "odd"});
  csv.AddRow({"a b", "a,b"});
  csv.AddRow({"", "say \"no\""});
  csv.AddRow({"1.5", "two\nlines"});
  csv.AddRow({"caf\xC3\xA9", "caf\xE9"});
  EXPECT_EQ(csv.text(),
            "plain,odd\na b,\"a,b\"\n,\"say \"\"no\"\"\"\n1.5,\"two\nlines\"\n"
            "caf\xC3\xA9,caf\\xE9\n");
  EXPECT_THROW(csv.AddRow({"one"}), std::invalid_argument);
}

TEST(CsvNumber, IsExactOrEmpty) {
  EXPECT_EQ(CsvNumber(0.1), "0.1");
  EXPECT_EQ(CsvNumber(-0.25), "-0.25");
  for (const double value : {double{NAN}, double{INFINITY}, -double{INFINITY}}) {
    EXPECT_EQ(CsvNumber(value), "");
  }
}

TEST(Csv, ReadsBackWhatItWrites) {
  const Fields columns = {"a", "b,c", "d\"e"};
  const std::vector<Fields> rows = {
      {"1", "", "x"}, {"\"", "\n", ",\r"}, {"", "", ""}, {" spaces ", "\"\"", "\xC3\xA9"}};
  CsvWriter csv(columns);
  for (const Fields& row : rows) csv.AddRow(row);
  const CsvFile file = ParseCsv(csv.text(), "f.csv");
  EXPECT_EQ(file.columns, columns);
  ASSERT_EQ(file.rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(file.rows[i].fields, rows[i]) << i;
}

TEST(Csv, TakesWhatSpreadsheetsWriteAndCountsItsLines) {
  const CsvFile file = ParseCsv("\xEF\xBB\xBF\"a\",b\r\n\r\n1,\"2\r\n3\"\r\n4,5", "f.csv");
  EXPECT_EQ(file.columns, (Fields{"a", "b"}));
  ASSERT_EQ(file.rows.size(), 2u);
  EXPECT_EQ(file.rows[0].line, 3);
  EXPECT_EQ(file.rows[0].fields, (Fields{"1", "2\n3"}));
  EXPECT_EQ(file.rows[1].line, 5);
  EXPECT_EQ(file.rows[1].fields, (Fields{"4", "5"}));
}

TEST(Csv, SaysWhereAFileIsBroken) {
  const struct {
    const char* text;
    const char* message;
  } cases[] = {
      {"", "f.csv:1: needs a header of column names"},
      {"\n\r\n", "f.csv:1: needs a header of column names"},
      {"a,b,a\n", "f.csv:1: a column comes twice"},
      {"a,b\n1,2\n3\n", "f.csv:3: has 1 fields, the header 2"},
      {"a,b\n1,2,\n", "f.csv:2: has 3 fields, the header 2"},
      {"a,b\n1,\"2\n3\n", "f.csv:2: a quote is not closed"},
      {"a,b\n1,\"2\"3\n", "f.csv:2: something follows a quote"},
      {"a,b\n1,2\n1,\xE9\n", "f.csv:3: must be UTF-8, has the byte \\xE9 (Latin-1?)"},
  };
  for (const auto& c : cases) {
    try {
      ParseCsv(c.text, "f.csv");
      ADD_FAILURE() << "was accepted: " << c.text;
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), c.message);
    }
  }
}

}  // namespace
}  // namespace sidestep::csv_test
