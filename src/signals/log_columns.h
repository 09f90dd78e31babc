// What every file format of a log shares: which column is which signal, how its numbers become SI, and what is refused.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/trouble.h"
#include "base/units.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "signals/one_pass.h"

namespace servodx {

// 27 hours at 1 kHz; 0.8 GB of memory a signal. A fit looks at seconds: nothing is lost by cutting a longer log.
inline constexpr std::size_t most_rows_of_a_log = 100'000'000;

// How a file format speaks of its columns and samples in an error.
struct LogFormat {
  bool has_units = true;  // a column's name may carry '[unit]'; else units come from the rig file alone
  bool has_lines = true;  // a sample is a line of the file; else it is named by its number
  std::size_t most_rows = most_rows_of_a_log;
};

class LogColumns {
 public:
  LogColumns(std::string path, const RigFile& rig, const ReadOptions& options, const LogFormat& format);

  // A column by its name in the file, in the file's order. Its position among the signals, or -1: it is no signal and
  // ignored. `line` is that of the header.
  int add(const std::string& name, long line);
  bool knows(const std::string& name) const;  // whether add() would take it for a signal
  void require_signals() const;               // after all are added
  std::size_t size() const { return columns_.size(); }
  const std::string& name(int column) const { return columns_[column].name; }
  Signal signal(int column) const { return columns_[column].signal; }

  const std::string& written_unit(int column) const { return columns_[column].written_unit; }
  double si(int column, double x) const { return columns_[column].to_si(x); }  // [SI] of a number as in the file

  void reserve(std::size_t samples);
  // One sample of every column, in the file's units; NaN where missing. `line`: of the file, or the sample's number.
  void append(std::span<const double> sample, long line);
  // All samples of all columns at once, in the order in which they were added; lengths and infinities are refused.
  void append_columns(const std::vector<std::span<const double>>& values);

  // `trouble`: the page of docs/errors.md that says more.
  [[noreturn]] void refuse_as(Trouble trouble, long line, const std::string& column, const std::string& rule,
                              const std::string& mend) const;
  [[noreturn]] void refuse(long line, const std::string& column, const std::string& rule,
                           const std::string& mend) const;
  void note(Note::Kind kind, std::string text) { log_.notes.push_back({kind, std::move(text)}); }

  Log finish(std::string sha256);

 private:
  struct Column {
    Signal signal;
    std::string name;
    Unit unit;  // of the file's numbers
    double gain = 1.0;
    double offset = 0.0;
    std::string written_unit;
    double full_scale = 0.0;
    std::vector<double> value = {};  // in the file's unit until finish()
    std::size_t missing = 0;
    long first_missing_line = 0;

    double to_si(double x) const {
      const double si = unit.to_si(x);
      return gain == 1.0 && offset == 0.0 ? si : gain * si + offset;
    }
    Sweep into_si();
  };

  const ColumnMapping* mapping_of(const std::string& cell, const std::string& name) const;
  Column resolve(Signal signal, const std::string& name, const std::string& unit, bool has_unit,
                 const ColumnMapping* mapping) const;
  bool present(Signal signal) const;
  [[noreturn]] void refuse_missing(Signal signal, const std::string& rule) const;
  InputError refusal(long line, const std::string& column, const std::string& rule, const std::string& mend) const;
  [[noreturn]] void refuse_rows(long line) const;
  void check_counts();
  void note_unmapped();

  std::string path_;
  const RigFile& rig_;
  const ReadOptions& options_;
  LogFormat format_;
  Log log_;
  std::vector<Column> columns_;
  std::vector<std::string> ignored_;
  int time_ = -1;  // position of the time column
  double previous_;
  long header_line_ = 0, last_line_ = 0;
};

}  // namespace servodx
