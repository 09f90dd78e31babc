#include "base/csv.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <vector>

#include "base/block_reader.h"
#include "base/decimal.h"
#include "base/random.h"
#include "base/reading_limits.h"
#include "servodx/error.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows rows_of(std::string_view text) {
  CsvCursor csv(text, "t.csv");
  Rows rows{csv.header()};
  while (csv.next_row()) {
    rows.emplace_back();
    for (std::string cell; csv.next_cell(cell);) rows.back().push_back(cell);
  }
  return rows;
}

TEST(Csv, SeparatorsLineEndsBomAndBlanksDoNotChangeTheCells) {
  const Rows expected = {{"a", "b [x]"}, {"1", "2"}, {"3", ""}};
  for (const char* text : {"a,b [x]\n1,2\n3,\n", "a;b [x]\n1;2\n3;\n", "a\tb [x]\n1\t2\n3\t\n",
                           "\xEF\xBB\xBF"
                           "a,b [x]\r\n1,2\r\n3,\r\n",
                           "# note, with commas; and \"quotes\n\na , b [x] \n\n 1, 2\n3 ,\n\n  \n", "a,b [x]\n1,2\n3,",
                           "a,b [x]\n\"1\",\"2\"\n3,\"\""})
    EXPECT_EQ(rows_of(text), expected) << text;
}

TEST(Csv, ACommaBeforeABlankIsAPartOfANameWhereSemicolonsStand) {
  EXPECT_EQ(rows_of("t, s;p, bar\n1;2\n").front(), (std::vector<std::string>{"t, s", "p, bar"}));
  EXPECT_EQ(rows_of("t, p\n1, 2\n").front(), (std::vector<std::string>{"t", "p"}));
}

TEST(Csv, HeadersInLatin1AreTheSameWordsInUtf8) {
  EXPECT_EQ(rows_of("\xD6l;T (\xB0"
                    "C)\n1;2\n")
                .front(),
            (std::vector<std::string>{"\xC3\x96l",
                                      "T (\xC2\xB0"
                                      "C)"}));
  EXPECT_EQ(rows_of("\xC3\x96l;x\n1;2\n").front(), (std::vector<std::string>{"\xC3\x96l", "x"}));
}

TEST(Csv, QuotedCellsHoldSeparatorsQuotesAndLineEnds) {
  EXPECT_EQ(rows_of("a,b\n\"x, \"\"y\"\"\",\"two\nlines\"\n"), (Rows{{"a", "b"}, {"x, \"y\"", "two\nlines"}}));
}

TEST(Csv, ACellWrittenIsTheCellRead) {
  for (const std::string cell : {"plain", "a,b", "a;b", "say \"x\"", "two\nlines", "#1", " led", "", "\t"}) {
    std::string text = "a,b\n";
    append_cell(text, cell);
    text += ",\n";
    EXPECT_EQ(rows_of(text).at(1).at(0), cell);
  }
}

TEST(Csv, LinesAreCountedThroughCommentsBlanksAndQuotedLineEnds) {
  CsvCursor csv("# c\n\na,b\n1,\"x\ny\"\n\n2,z\n", "t.csv");
  EXPECT_EQ(csv.header_line(), 3);
  EXPECT_EQ(csv.comments(), std::vector<std::string>{"c"});
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.line(), 4);
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.line(), 7);
  EXPECT_FALSE(csv.next_row());
}

TEST(Csv, NumbersAreNumbersMissingOrText) {
  const struct {
    const char* text;
    Cell kind;
    double value;
  } cases[] = {
      {"1.5", Cell::number, 1.5}, {" -2e-3 ", Cell::number, -2e-3}, {"+7", Cell::number, 7}, {"\"4\"", Cell::number, 4},
      {".5", Cell::number, 0.5},  {"1e-400", Cell::number, 0},      {"", Cell::missing, 0},  {"  ", Cell::missing, 0},
      {"NaN", Cell::missing, 0},  {"-nan", Cell::missing, 0},       {"inf", Cell::text, 0},  {"1e400", Cell::text, 0},
      {"1.5V", Cell::text, 0},    {"1 2", Cell::text, 0},           {"+-1", Cell::text, 0},  {"0x10", Cell::text, 0},
      {"off", Cell::text, 0},
  };
  for (const auto& c : cases) {
    const std::string text = "a,b\n" + std::string(c.text) + ",9\n";
    CsvCursor csv(text, "t.csv");
    ASSERT_TRUE(csv.next_row());
    double value = 0;
    EXPECT_EQ(csv.next_number(value), c.kind) << c.text;
    if (c.kind == Cell::number) {
      EXPECT_EQ(value, c.value) << c.text;
    } else {
      EXPECT_TRUE(std::isnan(value)) << c.text;
    }
    EXPECT_EQ(csv.next_number(value), Cell::number) << c.text;
    EXPECT_EQ(value, 9.0) << c.text;
    EXPECT_EQ(csv.next_number(value), Cell::none) << c.text;
  }
}

TEST(Csv, ADecimalCommaCountsWhereTheSeparatorIsASemicolon) {
  double value = 0;
  CsvCursor semicolons("a;b\n-1,25e3;2.5\n1,2,3;1.2,3\n", "t.csv");
  semicolons.next_row();
  EXPECT_EQ(semicolons.next_number(value), Cell::number);
  EXPECT_EQ(value, -1250.0);
  EXPECT_EQ(semicolons.next_number(value), Cell::number);
  EXPECT_EQ(value, 2.5);
  semicolons.next_row();
  EXPECT_EQ(semicolons.next_number(value), Cell::text);
  EXPECT_EQ(semicolons.last_text(), "1,2,3");
  EXPECT_EQ(semicolons.next_number(value), Cell::text);
  CsvCursor tabs("a\tb\n1,5\t2\n", "t.csv");
  tabs.next_row();
  EXPECT_EQ(tabs.next_number(value), Cell::number);
  EXPECT_EQ(value, 1.5);
  CsvCursor commas("a,b\n\"1,5\",2\n", "t.csv");
  commas.next_row();
  EXPECT_EQ(commas.next_number(value), Cell::text);
}

// 57.800 beside 107,9 is fifty-seven thousand; 0.125 is a number however others are written.
TEST(Csv, APointThatMayPartThousandsIsRememberedBesideDecimalCommas) {
  const auto found = [](std::string_view text, bool by_rows) {
    CsvCursor csv(text, "t.csv");
    std::vector<double> row(csv.header().size());
    double value = 0;
    while (csv.next_row())
      if (!by_rows || !csv.next_plain_row(row))
        while (csv.next_number(value) != Cell::none) {
        }
    const CellAt* cell = csv.thousands_among_commas();
    return cell ? std::to_string(cell->line) + ":" + cell->text : "";
  };
  for (const bool by_rows : {false, true}) {
    EXPECT_EQ(found("a;b\n1;57.800\n2;107,9\n", by_rows), "2:57.800");
    EXPECT_EQ(found("a;b\r\n107,9;+1\r\n2; -1.864\r\n", by_rows), "3:-1.864");
    EXPECT_EQ(found("a;b\n1;57.800\n2;107.9\n", by_rows), "") << "points are decimal here";
    EXPECT_EQ(found("a;b\n0.125;57.8001\n2.5;107,9\n", by_rows), "") << "no groups of three";
    EXPECT_EQ(found("a,b\n1,57.800\n", by_rows), "");
  }
}

TEST(Csv, AnyDoubleIsWrittenAndReadBackBitForBit) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::bit_cast<double>(random.bits64());
    if (!std::isfinite(x)) continue;
    std::string text = "a\n";
    append_number(text, x);
    text += '\n';
    CsvCursor csv(text, "t.csv");
    csv.next_row();
    double back = 0;
    ASSERT_EQ(csv.next_number(back), Cell::number) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(x)) << text;
  }
}

// The quick way to a number is the slow way's number, or says that it is not its business.
TEST(Csv, PlainDecimalsRoundAsTheStandardLibraryRounds) {
  Random random(3);
  int quick = 0;
  for (int i = 0; i < 200000; ++i) {
    std::string text = random.uniform() < 0.5 ? "-" : "";
    const auto digits = [&](double most) {
      for (int n = static_cast<int>(random.uniform(0, most)); n > 0; --n)
        text += static_cast<char>('0' + static_cast<int>(random.uniform(0, 10)));
    };
    digits(i % 3 ? 6 : 22);
    if (random.uniform() < 0.8) text += '.', digits(i % 5 ? 14 : 25);
    if (random.uniform() < 0.3) text += random.uniform() < 0.5 ? "e-" : "E+", digits(i % 7 ? 2 : 4);
    for (const char* behind : {"", ",1234567890"}) {
      const std::string all = text + behind;
      double plain = 0, standard = 0;
      const char* const end = parse_decimal(all.data(), all.data() + all.size(), '.', plain);
      const auto [after, error] = std::from_chars(all.data(), all.data() + all.size(), standard);
      if (!end) continue;
      ++quick;
      ASSERT_EQ(error, std::errc()) << all;
      ASSERT_EQ(end, after) << all;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(plain), std::bit_cast<std::uint64_t>(standard)) << all;
    }
  }
  EXPECT_GT(quick, 200000);
}

TEST(Csv, OnlyALastRowWithoutLineEndIsSaidToEndWithTheFile) {
  const auto ends = [](std::string_view text) {
    CsvCursor csv(text, "t.csv");
    csv.next_row();
    while (csv.skip_cell()) {
    }
    return csv.row_ended_by_file();
  };
  EXPECT_TRUE(ends("a,b\n1,2"));
  EXPECT_TRUE(ends("a,b\n1,"));
  EXPECT_FALSE(ends("a,b\n1,2\n"));
  EXPECT_FALSE(ends("a,b\n1,2\r\n"));
  EXPECT_FALSE(ends("a,b\n1,2\n3,4"));
}

// The files are as long as it takes to pass the limits; a reader that reads on would take them whole.
TEST(Csv, RowsAndHeadersBeyondTheLimitsAreRefusedWhereTheyPassThem) {
  const TemporaryFolder folder;
  const std::string much(std::size_t{20} << 20, 'x');
  const auto refusal = [&](const std::string& text) -> std::string {
    const std::string path = folder.write("t.csv", text);
    try {
      BlockReader file(path);
      CsvCursor csv(file, "t.csv");
      while (csv.next_row())
        while (csv.skip_cell()) {
        }
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string long_row = "the row is longer than 16 MB; end each row with a line end, and close quotes";
  EXPECT_EQ(refusal(much), "t.csv:1: " + long_row);
  EXPECT_EQ(refusal("a,b\n1,2\n" + much), "t.csv:3: " + long_row);
  EXPECT_EQ(refusal("a,b\n1,\"" + much + "\"\n"), "t.csv:2: " + long_row);
  EXPECT_EQ(refusal(std::string(much.size(), ',')), "t.csv:1: " + long_row);
  const std::string wide = "t.csv:1: the header has more than 10000 columns; keep the columns that are needed";
  EXPECT_EQ(refusal(std::string(10000, ',') + "\n"), wide);
  EXPECT_EQ(refusal(std::string(9999, ',') + "\n"), "accepted");
  EXPECT_EQ(refusal("a\n" + std::string(1000000, ',') + "\n"), "accepted");  // ragged: for the log to say
  EXPECT_EQ(refusal("a," + std::string(longest_name, 'b') + "\n"), "accepted");
  EXPECT_EQ(refusal("a," + std::string(15'000'000, 'b') + "\n"),
            "t.csv:1: the name of column 2 has more than 4096 bytes; shorten it");
  std::string comments;
  while (comments.size() <= 18u << 20) comments += "# " + std::string(100'000, 'c') + "\n";
  EXPECT_NE(refusal(comments + "a,b\n").find("the comments above the header have more than 16 MB; take them out"),
            std::string::npos);
}

TEST(Csv, ARowOfATextInMemoryIsHeldToTheSameLength) {
  const std::string much(std::size_t{20} << 20, 'x'), row(std::size_t{9} << 20, 'x');
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      rows_of(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string long_row = "the row is longer than 16 MB; end each row with a line end, and close quotes";
  EXPECT_EQ(refusal(much), "t.csv:1: " + long_row);
  EXPECT_EQ(refusal("a,b\n1,2\n" + much), "t.csv:3: " + long_row);
  EXPECT_EQ(refusal("a,b\n1,2\n" + std::string(much.size(), ',') + "\n"), "t.csv:3: " + long_row);
  EXPECT_EQ(refusal("a,b\n1,\"" + much + "\"\n"), "t.csv:2: " + long_row);
  EXPECT_EQ(refusal("a,b\n\"" + row + "\n\"," + row + "\n"), "t.csv:2: " + long_row);
  EXPECT_EQ(refusal("a,b\n1,\"" + row + "\"\n2,\"" + row + "\"\n"), "accepted");
}

// Were the line end looked for behind each quoted cell, this row would take minutes.
TEST(Csv, ALongRowOfQuotedCellsIsReadInTimeLinearInIt) {
  constexpr long cells = 1'000'000;  // 3 MB
  std::string text = "a,b\n";
  for (long k = 0; k < cells; ++k) text += "\"\",";
  text += "\"\n\"\n1,2\n";
  CsvCursor csv(text, "t.csv");
  ASSERT_TRUE(csv.next_row());
  long read = 0;
  for (std::string cell; csv.next_cell(cell);) ++read;
  EXPECT_EQ(read, cells + 1);
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.line(), 4);
}

TEST(Csv, TheBeginningIsGivenWhileItIsInMemory) {
  const std::string text = "first\nsecond\n";
  EXPECT_EQ(CsvCursor(text, "t.csv").from_beginning(), text);
  const TemporaryFolder folder;
  std::string long_text = "a,b\n";
  while (long_text.size() < 1u << 20) long_text += "1,2\n";
  BlockReader file(folder.write("t.csv", long_text));
  CsvCursor csv(file, "t.csv");
  EXPECT_TRUE(csv.from_beginning().starts_with("a,b\n1,2\n"));
  while (csv.next_row()) {
  }
  EXPECT_EQ(csv.from_beginning(), "");
}

TEST(Csv, EachRefusalSaysRuleAndMend) {
  const auto refusal = [](std::string_view text) -> std::string {
    try {
      rows_of(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(""), "t.csv: the file has no header row; begin it with a row of column names");
  EXPECT_EQ(refusal("# only\n\n"), "t.csv: the file has no header row; begin it with a row of column names");
  EXPECT_EQ(refusal("\xFF\xFE"
                    "a"),
            "t.csv:1: the text is UTF-16; save the file as UTF-8");
  EXPECT_EQ(refusal("a,b\n\"x,1\n"), "t.csv:2: a quoted cell is not closed; close it with '\"'");
  EXPECT_EQ(refusal("a,b\n\"x\"y,1\n"), "t.csv:2: text follows a quoted cell; double the quotes within the cell");
}

}  // namespace
}  // namespace servodx
