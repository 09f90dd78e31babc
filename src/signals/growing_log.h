// A CSV log that grows: bytes in, samples out, line by line.
//
// Header, units, separators, time stamps and the rig file's columns are those of a whole log (log_csv.cpp). A line that
// is half there waits for its rest. A line that is no sample (ragged, text in a column, no time) is counted and passed
// over: a log that is judged as it comes cannot be refused in its middle. Memory does not grow.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/sample.h"
#include "signals/time_stamp.h"

namespace servodx {

class LogColumns;

class GrowingLog {
 public:
  // `name` stands for the file in errors.
  GrowingLog(std::string name, const RigFile& rig);
  ~GrowingLog();
  GrowingLog(GrowingLog&&) noexcept;
  GrowingLog& operator=(GrowingLog&&) noexcept;

  // Takes every whole line; `end` is told how many bytes of what was fed so far end with the sample's line. Throws
  // InputError where the header cannot be used.
  using Take = std::function<void(const Sample& sample, std::uint64_t end)>;
  void feed(std::string_view bytes, const Take& take);
  // The same of a file whose end is reached: what is left is a line where it is whole.
  void end(const Take& take);

  bool begun() const { return columns_ != nullptr; }  // the header is read
  // Header, a row of units where there is one, and in a comment the stamp that the times count from.
  const std::string& head() const { return head_; }
  void begin_with(const std::string& head, std::uint64_t at);  // one that was read before; the next byte is at `at`
  bool has(Signal signal) const;
  std::string unit_of(Signal signal) const;  // as written in the header; empty: not there
  long bad_lines() const { return bad_lines_; }

 private:
  void line(std::string_view text, std::uint64_t end, const Take& take);
  bool begins_with(std::string_view text);
  void take_comment(std::string_view numbers);
  void read_head(const std::string& first);
  bool read_sample(std::string_view text, Sample& to);
  bool time_of(std::string_view cell, int column, double& time);
  char point() const { return separator_ == ',' ? '.' : ','; }

  std::string name_;
  const RigFile* rig_;
  std::unique_ptr<ReadOptions> options_ = std::make_unique<ReadOptions>();
  std::unique_ptr<LogColumns> columns_;
  std::vector<int> target_;  // of each column of the file: its position among the signals, or -1
  char separator_ = ',';
  std::vector<std::string> above_;    // lines before the first row of numbers
  std::string comment_;               // the last of these lines that begins with '#'
  std::optional<StampClock> stamps_;  // the times are stamps
  bool may_lack_last_ = false;
  std::string head_, half_;
  std::uint64_t fed_ = 0;
  long bad_lines_ = 0;
};

}  // namespace servodx
