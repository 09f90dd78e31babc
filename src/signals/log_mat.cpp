// MAT logs: read in a box, since matio and HDF5 crash on files that are damaged or made to harm. All of a file's
// signals are in memory at once, as matio gives them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "base/box.h"
#include "base/sha256.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/log_columns.h"
#include "signals/log_formats.h"
#include "signals/mat_file.h"
#include "signals/matio_library.h"

namespace servodx {
namespace {

// What the child gives: a word of what follows, then texts and numbers, each behind its length.
enum class Part : std::uint64_t { variable = 1, refusal = 2 };

void give_number(const Box::Give& give, std::uint64_t n) { give({reinterpret_cast<const char*>(&n), sizeof n}); }
void give_text(const Box::Give& give, const std::string& text) {
  give_number(give, text.size());
  give(text);
}

// A log packs its signals at most some ten times into a file, and matio holds them twice; a file of a kilobyte that
// asks for gigabytes is no log. Inflating runs at 100 MB/s, ten times what is granted.
BoxLimits limits_for(std::size_t file_size) {
  constexpr std::size_t least = std::size_t{256} << 20, a_byte = 64, bytes_a_second = std::size_t{1} << 20;
  return {.memory = least + a_byte * file_size, .seconds = 2 + file_size / bytes_a_second};
}

// Reads a file's variables in a child, and hands them on one by one.
class MatChild {
 public:
  explicit MatChild(const std::string& path) : path_(path), sha256_(sha256_of_file(path)) {
    std::error_code unknown;
    const auto size = std::filesystem::file_size(path, unknown);
    limits_ = limits_for(unknown ? 0 : size);
    limits_.file = path;
  }
  const std::string& sha256() const { return sha256_; }
  bool filters_calls() const { return filters_calls_; }

  // `wants`: whose numbers are wanted; of the others comes the name alone.
  void read(const std::function<bool(const std::string& name)>& wants, const std::function<void(MatVariable&&)>& take) {
    std::optional<InputError> unread;
    Box box(
        limits_, [&](const Box::Give& give) { unread ? give_refusal(*unread, give) : give_all(wants, give); },
        [&] {
          try {
            load_matio(path_);
          } catch (const InputError& error) {
            unread = error;
          }
        });
    filters_calls_ = box.filters_calls();
    for (std::uint64_t part = 0; box.take(&part, sizeof part);)
      if (!(part == static_cast<std::uint64_t>(Part::variable) ? take_variable(box, take) : refuse_as_told(box))) break;
    require_whole(box.end());
  }

 private:
  static void give_refusal(const InputError& error, const Box::Give& give) {
    give_number(give, static_cast<std::uint64_t>(Part::refusal));
    give_text(give, error.rule);
    give_text(give, error.mend);
  }

  void give_all(const std::function<bool(const std::string& name)>& wants, const Box::Give& give) const {
    try {
      read_mat_file(path_, [&](const MatVariable& v) {
        give_number(give, static_cast<std::uint64_t>(Part::variable));
        give_text(give, v.name);
        give_text(give, v.fault);
        const std::size_t bytes = wants(v.name) ? v.numbers.size() * sizeof(double) : 0;
        give_number(give, bytes);
        give({reinterpret_cast<const char*>(v.numbers.data()), bytes});
      });
    } catch (const InputError& error) {
      give_refusal(error, give);
    }
  }

  // What a child gives is not trusted either: no more is taken than the child could hold.
  template <class Values>
  bool take_values(Box& box, Values& values) const {
    std::uint64_t bytes = 0;
    if (!box.take(&bytes, sizeof bytes) || bytes > limits_.memory) return false;
    values.resize(bytes / sizeof values[0]);
    return box.take(values.data(), values.size() * sizeof values[0]);
  }

  bool take_variable(Box& box, const std::function<void(MatVariable&&)>& take) const {
    MatVariable v;
    if (!take_values(box, v.name) || !take_values(box, v.fault) || !take_values(box, v.numbers)) return false;
    take(std::move(v));
    return true;
  }

  bool refuse_as_told(Box& box) const {
    std::string rule, mend;
    if (take_values(box, rule) && take_values(box, mend)) throw InputError({path_, 0, ""}, rule, mend);
    return false;
  }

  void require_whole(BoxEnd end) const {
    if (end == BoxEnd::whole) return;
    const std::string why =
        end == BoxEnd::out_of_memory    ? fmt::format("it asks for more than {} MB", limits_.memory >> 20)
        : end == BoxEnd::out_of_time    ? fmt::format("it takes more than {} s of processor", limits_.seconds)
        : end == BoxEnd::forbidden_call ? "it makes the MAT library ask the system for what reading does not need"
                                        : "the MAT library crashed on it";
    throw InputError({path_, 0, ""}, "is damaged: " + why, "save it again with MATLAB's 'save', or write a CSV log");
  }

  const std::string& path_;
  std::string sha256_;  // first, as it refuses what cannot be read
  BoxLimits limits_;
  bool filters_calls_ = false;
};

}  // namespace

Log read_mat_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  LogColumns log(path, rig, options, {.has_units = false, .has_lines = false});
  MatChild child(path);
  std::vector<std::vector<double>> values;  // as in the file, in the order of the log's columns
  child.read([&](const std::string& name) { return log.knows(name); },
             [&](MatVariable&& v) {
               if (log.add(v.name, 0) < 0) return;
               if (!v.fault.empty())
                 log.refuse(0, v.name, v.fault, "save each signal as a vector of numbers, one a sample");
               values.push_back(std::move(v.numbers));
             });
  log.require_signals();
  log.append_columns({values.begin(), values.end()});
  if (!child.filters_calls())
    log.note(Note::Kind::unguarded,
             "the MAT library read this file without a filter of system calls, which this system refuses: its memory, "
             "time and open files were limited; read files that you do not trust elsewhere");
  return log.finish(child.sha256());
}

std::vector<MatVariable> read_mat_variables(const std::string& path) {
  std::vector<MatVariable> variables;
  MatChild(path).read([](const std::string&) { return true; },
                      [&](MatVariable&& v) { variables.push_back(std::move(v)); });
  return variables;
}

}  // namespace servodx
