#include "reports/csv/csv_table.h"

#include <gtest/gtest.h>

namespace stiffscope::page {
namespace csv_table_test {

TEST(CsvTable, QuotesAsTheStandardSays) {
  const reports::Table table{"c", {"Name", "Text"}, {{"", {{"a,b", "say \"so\""}, {"plain", "k_{1}"}}}}};
  EXPECT_EQ(reports::csvTable(table), "Name,Text\r\n\"a,b\",\"say \"\"so\"\"\"\r\nplain,k1\r\n");
}

TEST(CsvTable, NumbersAsAProgramReadsThem) {
  const reports::Table table{"c", {"Joint", "PP"}, {{"", {{"k_{2}", "−5.60 ± 0.10"}, {"k_{3}", "–"}}}}};
  EXPECT_EQ(reports::csvTable(table), "Joint,PP,± of PP\r\nk2,-5.60,0.10\r\nk3,,\r\n");
}

TEST(CsvTable, AHeaderThatNamesBothIsSplitToo) {
  const reports::Table table{"c", {"Joint", "Mean ± sd"}, {{"", {{"k_{2}", "1 ± 2"}}}}};
  EXPECT_EQ(reports::csvTable(table), "Joint,Mean,sd\r\nk2,1,2\r\n");
}

TEST(CsvTable, GroupsAndRemarksStandInEveryRow) {
  const reports::Table table{
      "c", {"At", "Method", "Value"}, {{"wrist", {{"CP", reports::Cell("1", "negative a")}, {"PP", "2"}}}}};
  EXPECT_EQ(reports::csvTable(table), "At,Method,Value,Remark\r\nwrist,CP,1,negative a\r\nwrist,PP,2,\r\n");
}

}  // namespace csv_table_test
}  // namespace stiffscope::page
