// MAT logs: read in a box, since matio and HDF5 crash on files that are damaged or made to harm. All of a file's
// signals are in memory at once, as matio gives them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "base/box.h"
#include "base/sha256.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/log_columns.h"
#include "signals/log_formats.h"
#include "signals/mat_file.h"

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

class MatReader {
 public:
  MatReader(const std::string& path, const RigFile& rig, const ReadOptions& options)
      : path_(path), log_(path, rig, options, {.has_units = false, .has_lines = false}) {}

  Log read() {
    std::string hash = sha256_of_file(path_);  // refuses what cannot be read
    std::error_code unknown;
    const auto size = std::filesystem::file_size(path_, unknown);
    limits_ = limits_for(unknown ? 0 : size);
    Box box(limits_, [this](const Box::Give& give) { give_all(give); });
    for (std::uint64_t part = 0; box.take(&part, sizeof part);)
      if (!(part == static_cast<std::uint64_t>(Part::variable) ? take_variable(box) : refuse_as_told(box))) break;
    require_whole(box.end());
    log_.require_signals();
    log_.append_columns({values_.begin(), values_.end()});
    return log_.finish(std::move(hash));
  }

 private:
  void give_all(const Box::Give& give) const {
    try {
      read_mat_file(path_, [&](const MatVariable& v) {
        give_number(give, static_cast<std::uint64_t>(Part::variable));
        give_text(give, v.name);
        give_text(give, v.fault);
        const std::size_t bytes = log_.knows(v.name) ? v.numbers.size() * sizeof(double) : 0;
        give_number(give, bytes);
        give({reinterpret_cast<const char*>(v.numbers.data()), bytes});
      });
    } catch (const InputError& error) {
      give_number(give, static_cast<std::uint64_t>(Part::refusal));
      give_text(give, error.rule);
      give_text(give, error.mend);
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

  bool take_variable(Box& box) {
    std::string name, fault;
    std::vector<double> numbers;
    if (!take_values(box, name) || !take_values(box, fault) || !take_values(box, numbers)) return false;
    if (log_.add(name, 0) < 0) return true;
    if (!fault.empty()) log_.refuse(0, name, fault, "save each signal as a vector of numbers, one a sample");
    values_.push_back(std::move(numbers));
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
        end == BoxEnd::out_of_memory ? fmt::format("it asks for more than {} MB", limits_.memory >> 20)
        : end == BoxEnd::out_of_time ? fmt::format("it takes more than {} s of processor", limits_.seconds)
                                     : "the MAT library crashed on it";
    throw InputError({path_, 0, ""}, "is damaged: " + why, "save it again with MATLAB's 'save', or write a CSV log");
  }

  const std::string& path_;
  LogColumns log_;
  BoxLimits limits_;
  std::vector<std::vector<double>> values_;  // as in the file, in the order of the log's columns
};

}  // namespace

Log read_mat_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  return MatReader(path, rig, options).read();
}

}  // namespace servodx
