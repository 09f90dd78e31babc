// Headers of other people's recorders: no column may be taken for a signal that it is not without a question.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "signals/guess.h"

namespace servodx {
namespace {

struct ForeignHeader {
  std::string name;
  std::vector<std::string> cells, truths;  // "-": no signal of the valve; "?": the values alone can tell
};

std::vector<ForeignHeader> foreign_headers() {
  std::vector<ForeignHeader> all;
  std::ifstream file(SERVODX_SOURCE_DIR "/tests/signals/foreign_headers.txt");
  const std::string begin = "header ";
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    if (line.starts_with(begin)) {
      all.push_back({line.substr(begin.size()), {}, {}});
      continue;
    }
    const auto colon = line.find(": ");
    all.back().truths.push_back(line.substr(0, colon));
    all.back().cells.push_back(line.substr(colon + 2));
  }
  return all;
}

std::string name_of(const ColumnGuess& g) { return g.signal ? std::string(info(*g.signal).name) : "-"; }

TEST(ForeignHeaders, NoneIsMappedWronglyInSilence) {
  int right = 0, asked = 0;
  for (const ForeignHeader& header : foreign_headers()) {
    const std::vector<ColumnGuess> guesses = guess_columns(header.cells);
    for (std::size_t c = 0; c < guesses.size(); ++c) {
      const ColumnGuess& g = guesses[c];
      const bool silent = g.question.empty() && !g.weak;
      if (!g.signal) continue;
      ++(silent ? right : asked);
      EXPECT_TRUE(!silent || name_of(g) == header.truths[c]) << header.name << ": " << g.cell << " as " << name_of(g);
    }
  }
  EXPECT_GT(right, 250);  // who asks of everything is never wrong
  EXPECT_GT(asked, 20);
}

// What is asked is the right question: the signal that a person would take it for, so that the answer is a word.
TEST(ForeignHeaders, WhatAPersonWouldKnowIsFound) {
  for (const ForeignHeader& header : foreign_headers()) {
    const std::vector<ColumnGuess> guesses = guess_columns(header.cells);
    for (std::size_t c = 0; c < guesses.size(); ++c) {
      const std::string& truth = header.truths[c];
      EXPECT_TRUE(truth == "-" || truth == "?" || truth == name_of(guesses[c]))
          << header.name << ": " << guesses[c].cell << " as " << name_of(guesses[c]);
    }
  }
}

}  // namespace
}  // namespace servodx
