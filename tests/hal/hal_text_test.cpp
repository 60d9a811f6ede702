#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "outcome_matchers.h"
#include "support/temp_folder.h"
#include "text/file.h"
#include "text/parse.h"
#include "text/sentence.h"
#include "text/stamps.h"

namespace accrete::hal {
namespace {

using test::TempFolder;

TEST(Rows, SkipCommentsAndBlanksAndCountLines) {
  RowReader rows("# head\r\n\r\n  a b\tc  \r\n   \n\t# more\nd,, e ,\nlast");
  Row row;
  ASSERT_TRUE(rows.next(row));
  EXPECT_EQ(row.line, 3U);
  ASSERT_EQ(row.field_count, 3U);
  EXPECT_EQ(row.fields[0], "a");
  EXPECT_EQ(row.fields[2], "c");
  EXPECT_FALSE(row.comma_separated);
  ASSERT_TRUE(rows.next(row));
  EXPECT_EQ(row.line, 6U);
  ASSERT_EQ(row.field_count, 4U);
  EXPECT_EQ(row.fields[1], "");
  EXPECT_EQ(row.fields[2], "e");
  EXPECT_EQ(row.fields[3], "");
  EXPECT_TRUE(row.comma_separated);
  ASSERT_TRUE(rows.next(row));
  EXPECT_EQ(row.fields[0], "last");
  EXPECT_FALSE(rows.next(row));
}

TEST(Rows, BoundLengthAndFields) {
  const std::string many(2 * Row::kMaxFields, ','), spaced = "1 " + std::string(Row::kMaxLength, '2');
  for (const std::string& text : {many, spaced}) {
    RowReader rows(text);
    Row row;
    ASSERT_TRUE(rows.next(row));
    EXPECT_EQ(row.field_count, Row::kMaxFields + 1);
  }
}

TEST(Numbers, WholeFieldOrNothing) {
  double d = 0;
  EXPECT_TRUE(parse("+1.5e-3", d));
  EXPECT_EQ(d, 1.5e-3);
  EXPECT_TRUE(parse("0.", d));
  for (const char* bad : {"", "+", "1,5", "1.5x", "+-1", "0x10", " 1", "1e400"}) EXPECT_FALSE(parse(bad, d)) << bad;
  std::int64_t i = 0;
  EXPECT_TRUE(parse("-9223372036854775808", i));
  for (const char* bad : {"9223372036854775808", "1.0", "1e3", ""}) EXPECT_FALSE(parse(bad, i)) << bad;
}

TEST(Numbers, DecimalsAreExactToTheNanosecond) {
  struct Case {
    const char* text;
    std::int64_t ns;
  };
  for (const Case& c : {Case{"1403636579.763555584", 1403636579763555584}, Case{"0.033333", 33333000},
                        Case{"1.036224e-01", 103622400}, Case{"-2.5", -2500000000}, Case{"7", 7000000000},
                        Case{".5", 500000000}, Case{"5.", 5000000000}, Case{"0.0000000005", 1}, Case{"0.0000000004", 0},
                        Case{"0.9999999999", 1000000000}, Case{"1.4e9", 1400000000000000000},
                        Case{"0000000000000000000000012.25", 12250000000}, Case{"3e-30", 0}, Case{"+1", 1000000000}}) {
    Decimal d;
    ASSERT_TRUE(parse(c.text, d)) << c.text;
    ASSERT_TRUE(d.fits_ns()) << c.text;
    EXPECT_EQ(d.ns(), c.ns) << c.text;
  }
  Decimal d;
  for (const char* bad :
       {"", ".", "-", "nan", "inf", "1e", "e5", "1.2.3", "1e999", "12345678901234567890", "0x1", "--1"})
    EXPECT_FALSE(parse(bad, d)) << bad;
  ASSERT_TRUE(parse("1403636579763555584", d));
  EXPECT_FALSE(d.fits_ns());
}

TEST(Stamps, AboveTheLimitAreNanosecondsAndSaidSo) {
  StampColumn column;
  Row row;
  row.line = 1;
  row.fields[0] = "1403636579763555584";
  ASSERT_TRUE(succeeds(column.add("t.txt", row, 0)));
  std::vector<Timestamp> stamps;
  std::vector<std::string> notices;
  ASSERT_TRUE(succeeds(column.convert("t.txt", stamps, notices)));
  EXPECT_EQ(stamps[0].ns, 1403636579763555584);
  EXPECT_TRUE(says(notices, {"t.txt", "nanoseconds"}));
  row.line = 2;
  row.fields[0] = "8000000000000000000";  // no difference of this to another one fits 64 bits
  ASSERT_TRUE(succeeds(column.add("t.txt", row, 0)));
  EXPECT_TRUE(fails(column.convert("t.txt", stamps, notices), Status::kInvalidArgument, {"t.txt, line 2"}));
  row.fields[0] = "nan";
  EXPECT_TRUE(fails(column.add("t.txt", row, 0), Status::kInvalidArgument, {"t.txt, line 2", "'nan'", "seconds"}));
}

TEST(Files, SayWhatIsWrong) {
  const TempFolder folder;
  std::string text;
  EXPECT_TRUE(fails(read_text(folder / "none.txt", text), Status::kNotFound, {"none.txt", "not there"}));
  EXPECT_TRUE(fails(read_text(folder.path(), text), Status::kNotFound, {"no regular file"}));
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_TRUE(
      fails(read_text(folder / "loop", text), Status::kDataLoss, {"loop", "cannot be reached", "symbolic links"}));
  EXPECT_TRUE(fails(read_text(folder.write("e.txt", ""), text), Status::kDataLoss, {"e.txt", "empty"}));
  EXPECT_TRUE(fails(read_text(folder.write("u.txt",
                                           "\xff\xfe"
                                           "a"),
                              text),
                    Status::kUnsupported, {"u.txt", "UTF-8"}));
  EXPECT_TRUE(
      fails(read_text(folder.write("b.txt", "12345"), text, 4), Status::kCapacityExceeded, {"b.txt", "5 bytes"}));
  ASSERT_TRUE(succeeds(read_text(folder.write("bom.txt",
                                              "\xef\xbb\xbf"
                                              "abc"),
                                 text)));
  EXPECT_EQ(text, "abc");
}

TEST(Files, ANamedPipeDoesNotBlock) {
  std::string text;
  EXPECT_TRUE(fails(read_text("/dev/zero", text), Status::kNotFound, {"/dev/zero", "no regular file"}));
}

TEST(Sentences, QuoteNothingThatATerminalObeys) {
  EXPECT_EQ(in_quotes("a\x1b[31m\n"), "'a?[31m?'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
  EXPECT_EQ(count(1, "frame") + ", " + count(2, "frame"), "1 frame, 2 frames");
}

}  // namespace
}  // namespace accrete::hal
