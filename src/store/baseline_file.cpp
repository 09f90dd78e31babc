#include "store/baseline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/key_error.h"
#include "base/reading_limits.h"
#include "base/result_schema.h"
#include "base/sha256.h"
#include "diagnose/baseline.h"
#include "diagnose/record_figures.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/operating_point.h"
#include "store/baseline_keys.h"

namespace servodx::store {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* make_again = "make it again with 'servodx baseline'";

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  Json parse(const std::string& text) const {
    refuse_beyond_limits(text, path_, make_again);
    try {
      return Json::parse(text);
    } catch (const Json::parse_error& error) {
      const auto end = text.begin() + static_cast<long>(std::min(error.byte, text.size()));
      const long line = 1 + std::count(text.begin(), end, '\n');
      throw InputError({path_, line, ""}, "is not JSON", make_again);
    } catch (const Json::out_of_range&) {
      throw InputError({path_, 0, ""}, "holds a number beyond 1.8e308", make_again);
    }
  }
  // The value under a dotted key; `inside` is the object that holds its last part.
  const Json& at(const Json& inside, const std::string& key) const {
    const std::string last = key.substr(key.rfind('.') + 1);
    if (!inside.is_object()) refuse(key, "is not in an object");
    const auto found = inside.find(last);
    if (found == inside.end()) refuse(key, "is missing");
    return *found;
  }
  double number(const Json& inside, const std::string& key, double lower, double upper) const {
    const Json& value = at(inside, key);
    if (!value.is_number()) refuse(key, "is not a number");
    const auto x = value.get<double>();
    if (!(x >= lower && x <= upper)) refuse(key, "is out of range: " + value.dump());
    return x;
  }
  int count(const Json& inside, const std::string& key) const {
    const Json& value = at(inside, key);
    if (!value.is_number_integer()) refuse(key, "is not a whole number");
    const auto n = value.get<long>();
    if (n < 0 || n > 1'000'000'000) refuse(key, "is out of range: " + value.dump());
    return static_cast<int>(n);
  }
  std::string text(const Json& inside, const std::string& key) const {
    const Json& value = at(inside, key);
    if (!value.is_string()) refuse(key, "is not a text");
    return value.get<std::string>();
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& rule) const {
    throw key_error({path_, 0, key}, rule, make_again);
  }

 private:
  std::string path_;
};

TestConditions read_test(const Reader& read, const Json& test) {
  TestConditions c;
  c.drive_span = read.number(test, "scores.test.drive_span", 0, HUGE_VAL);
  if (test.contains("drive_rms")) c.drive_rms = read.number(test, "scores.test.drive_rms", 0, HUGE_VAL);  // later
  c.drive_band = read.number(test, "scores.test.drive_band", 0, HUGE_VAL);
  if (!read.at(test, "scores.test.temperature").is_null())
    c.temperature = read.number(test, "scores.test.temperature", 0, HUGE_VAL);
  return c;
}

OperatingPoint read_point(const Reader& read, const Json& point) {
  if (!point.is_object()) read.refuse("scores.operating_point", "is no object");
  OperatingPoint out;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (const std::string key = key_of(static_cast<Condition>(i)); point.contains(key))
      out[i] = read.number(point, "scores.operating_point." + key, -HUGE_VAL, HUGE_VAL);
  return out;
}

std::optional<FigureKind> find_figure(const std::string& key) {
  for (int k = 0; k < n_figure_kinds; ++k)
    if (key_of(static_cast<FigureKind>(k)) == key) return static_cast<FigureKind>(k);
  return {};
}

// A figure that this version does not know is left out.
std::vector<RecordFigure> read_figures(const Reader& read, const Json& figures) {
  if (!figures.is_array()) read.refuse("scores.figures", "is no array");
  std::vector<RecordFigure> out;
  for (const Json& f : figures) {
    const auto kind = find_figure(read.text(f, "scores.figures.figure"));
    const auto signal = find_signal(read.text(f, "scores.figures.signal"));
    const double value = read.number(f, "scores.figures.value", 0, HUGE_VAL);
    if (kind && signal) out.push_back({*kind, *signal, value});
  }
  return out;
}

std::vector<DetectionBaseline::Score> read_scores(const Reader& read, const Json& scores) {
  constexpr double any = HUGE_VAL;
  if (!scores.is_array()) read.refuse("scores", "is no array");
  std::vector<DetectionBaseline::Score> out;
  for (const Json& s : scores) {
    out.push_back({read.text(s, "scores.log"), read.text(s, "scores.sha256"), read.number(s, "scores.score", -any, any),
                   read.number(s, "scores.adequacy", 0, any)});
    const Json& gains = read.at(s, "scores.gains");
    if (!gains.is_object()) read.refuse("scores.gains", "is no object");
    for (const auto& [name, value] : gains.items()) {
      const double gain = read.number(gains, "scores.gains." + name, -any, any);
      if (const Fault* fault = find_fault(name)) out.back().gains[fault] = gain;
    }
    if (s.contains("figures")) out.back().figures = read_figures(read, s["figures"]);  // nor these
    if (s.contains("operating_point")) out.back().point = read_point(read, s["operating_point"]);
    if (s.contains("test")) out.back().test = read_test(read, s["test"]);            // earlier versions wrote none
    if (s.contains("content")) out.back().content = read.text(s, "scores.content");  // nor this
  }
  return out;
}

// The rig file among the inputs of the call that made it.
std::string rig_of(const Json& file) {
  const auto inputs = file.find("inputs");
  if (inputs == file.end() || !inputs->is_array()) return "";
  for (const Json& input : *inputs)
    if (input.is_object() && input.contains("path") && input["path"].is_string())
      if (std::string path = input["path"].get<std::string>(); path.ends_with(".toml")) return path;
  return "";
}

// Nothing in a file of an earlier version.
std::optional<BaselineOf> read_made_of(const Reader& read, const Json& file) {
  const auto found = file.find("made_of");
  if (found == file.end()) return {};
  BaselineOf out;
  const Json &rig = read.at(*found, "made_of.rig"), &signals = read.at(*found, "made_of.signals");
  if (!rig.is_object()) read.refuse("made_of.rig", "is no object");
  for (const auto& [key, value] : rig.items()) {
    if (!value.is_string()) read.refuse("made_of.rig", "says of '" + key + "' what is no text");
    out.rig[key] = value.get<std::string>();
  }
  if (!signals.is_array()) read.refuse("made_of.signals", "is no array");
  for (const Json& signal : signals) {
    if (!signal.is_string()) read.refuse("made_of.signals", "holds what is no text");
    out.signals.push_back(signal.get<std::string>());
  }
  return out;
}

}  // namespace

BaselineFile read_baseline(const std::string& path) {
  const std::string bytes = read_file_within(path, largest_json);
  const Reader read(path);
  const Json file = read.parse(bytes);
  if (!file.is_object()) throw InputError({path, 0, ""}, "is no object", make_again);
  if (const std::string command = read.text(file, "command"); command != "baseline")
    throw key_error({path, 0, "command"}, "is the result of '" + command + "', not of 'baseline'",
                    "name the file that 'servodx baseline -o' wrote");

  std::vector<Note> notes;
  if (auto notice = schema_notice(file, path)) notes.push_back({Note::Kind::earlier_version, std::move(*notice)});

  constexpr double any = HUGE_VAL;
  DetectionBaseline b;
  b.threshold = read.number(file, "threshold", 0, any);
  const Json& rate = read.at(file, "false_alarm");
  b.asked = read.number(rate, "false_alarm.asked", 0, 1);
  b.promised = read.number(rate, "false_alarm.promised", 0, 1);
  b.promised_95 = read.number(rate, "false_alarm.promised_95", 0, 1);
  b.logs = read.count(rate, "false_alarm.logs");
  b.logs_needed = read.count(rate, "false_alarm.logs_needed");
  const Json& scores = read.at(file, "scores");
  if (!scores.is_array() || scores.empty()) read.refuse("scores", "holds no scores");
  b.scores = read_scores(read, scores);
  if (file.contains("others")) b.others = read_scores(read, file["others"]);  // earlier versions wrote none
  b.adequacy_limit = read.number(file, "adequacy_limit", 0, any);
  b.null_limit = read.number(file, "null_limit", 0, 1);
  b.tuned_sha256 = read.text(file, "tuned_sha256");
  return {
      std::move(b), sha256(bytes), std::move(notes), rig_of(file), read_made_of(read, file), file.contains("explain")};
}

}  // namespace servodx::store
