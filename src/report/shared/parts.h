// The parts a page is made of. A part knows nothing of valves: it is what a command found, in words and numbers.
//
// Every part is also a CSV: a plot its columns, a table its cells at full precision.
#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace servodx::report {

// What a series stands for; decides colour and dash everywhere alike.
enum class Role { measured, reference, named, other, input };
// Of a verdict, a bar, a cell.
enum class Tone { plain, good, bad, doubt };

struct Series {
  std::string name;
  std::vector<double> y;  // NaN: a gap
  Role role = Role::measured;
  bool points = false;  // dots, no line
};

struct Band {
  std::string name;
  std::vector<double> lower, upper;
};

struct Mark {  // a line across the plot
  double at = 0;
  std::string label;
};

struct Plot {
  std::string title = {};     // "spool position [mm]"
  std::string x_label = {};   // "time [s]"
  bool x_label_shown = true;  // under the axis; without: only beside the cursor's value
  std::vector<double> x = {};
  std::vector<Series> series = {};
  std::optional<Band> band = {};
  std::vector<Mark> x_marks = {}, y_marks = {};
  std::string group = {};  // plots of one group share zoom and cursor; empty: alone
  bool low = false;        // half the height
  bool log_x = false, log_y = false;
  std::size_t most_rows = 8000;  // beyond this, thinned (report/shared/plot_samples.h)
};

// A cell's text, and the number behind it for the CSV.
struct Cell {
  Cell(std::string words) : text(std::move(words)) {}  // NOLINT: a word is a cell
  Cell(const char* words) : text(words) {}             // NOLINT
  Cell(std::string words, double number) : text(std::move(words)), value(number) {}
  std::string text;
  std::optional<double> value = {};
  Tone tone = Tone::plain;
  std::string link = {};  // "#id" on the page, or another page
};

struct TablePart {
  std::string title;
  std::string alignment;  // 'l' or 'r' a column
  std::vector<std::string> head;
  std::vector<std::vector<Cell>> rows;
  std::size_t shown = 0;  // further rows are folded away; 0: all are shown
};

// Ranking, scores, final costs: a bar a row, from zero.
struct Bars {
  std::string title;
  std::string label, unit;  // heads of the columns: "hypothesis", "probability"
  struct Row {
    std::string label;
    double value = 0;
    std::string text;  // the value as it is read
    std::string note = {};
    Tone tone = Tone::plain;
    std::string link = {};
  };
  std::vector<Row> rows;
  std::optional<Mark> mark;    // "threshold"
  std::optional<double> full;  // value of a full bar; empty: the greatest
  std::size_t shown = 0;       // as of a table
};

// What moved, and by how many of its standard errors.
struct Moves {
  std::string title;
  struct Row {
    std::string name = {}, from = {}, to = {}, error = {}, unit = {};
    double sigmas = NAN;                                     // signed; NaN: no error is known
    std::string note = {};                                   // what it means; its verdict
    double exact_from = 0, exact_to = 0, exact_error = NAN;  // [exact_unit]
    std::string exact_unit = {};
  };
  std::vector<Row> rows;
  std::size_t shown = 0;
};

// What is driven both ways: a bar to the left for its minimum, to the right for its maximum, by the logarithm.
struct Tornado {
  std::string title;
  std::string label, unit;  // heads of the columns: "row", "times the noise"
  struct Row {
    std::string name;
    std::array<double, 2> value = {NAN, NAN};  // not negative; NaN: no bar
    std::array<std::string, 2> text = {};      // the values as they are read
    std::string note = {};
  };
  std::vector<Row> rows;
  std::size_t shown = 0;  // as of a table
};

// A grid of numbers, darker where greater: confusion, residual maps.
struct Matrix {
  std::string title;
  std::string row_label, column_label;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> value;  // [row][column]; NaN: blank
  std::string unit = {};
  bool diagonal_is_right = false;  // confusion
};

struct Verdict {
  Tone tone = Tone::plain;
  std::string word = {};      // "FAULT"
  std::string headline = {};  // "feedback wire backlash, 20.7 um (17.6 to 23.9, 95 %)"
  std::string detail = {};    // one sentence in plain words
  std::vector<std::pair<std::string, std::string>> facts = {};
  std::vector<std::string> reasons = {};
};

}  // namespace servodx::report
