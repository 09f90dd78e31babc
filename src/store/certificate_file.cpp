#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "base/key_error.h"
#include "base/nearest.h"
#include "base/reading_limits.h"
#include "base/sha256.h"
#include "base/toml_text.h"
#include "base/trouble.h"
#include "base/units.h"
#include "servodx/certificate.h"
#include "servodx/curves.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {
namespace {

bool is_date(const std::string& text) {
  if (text.size() != 10) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i == 4 || i == 7 ? text[i] != '-' : !std::isdigit(static_cast<unsigned char>(text[i]))) return false;
  const int month = std::stoi(text.substr(5, 2)), day = std::stoi(text.substr(8, 2));
  return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

class CertificateReader {
 public:
  explicit CertificateReader(const std::string& path) { out_.path = path; }

  Certificate read() {
    const std::string text = read_file_within(out_.path, largest_toml);
    out_.sha256 = sha256(text);
    const toml::table root =
        parse_toml(text, out_.path, "mend the line; every value is a quoted string, a number or a table");
    for (const auto& [name, node] : root) read_key(std::string(name.str()), node);
    if (out_.date.empty())
      throw key_error({out_.path, 0, "date"}, "is missing: whether an instrument was calibrated depends on it",
                      "add date = \"2026-11-25\"");
    if (!out_.issued.empty() && out_.issued < out_.date)
      throw key_error(issued_at_, "is before the test of " + out_.date, "give the day on which it is issued");
    return std::move(out_);
  }

 private:
  Place at(const toml::node& node, const std::string& key) const { return {out_.path, node.source().begin.line, key}; }

  std::string word(const toml::node& node, const std::string& key) const {
    if (!node.is_string()) throw key_error(at(node, key), "is not a string", "put the value in quotes");
    return node.as_string()->get();
  }

  std::string date(const toml::node& node, const std::string& key) const {
    const std::string text = word(node, key);
    if (!is_date(text)) throw key_error(at(node, key), "'" + text + "' is no date", "write \"2026-11-25\"");
    return text;
  }

  [[noreturn]] void refuse_key(const toml::node& node, const std::string& key, const std::string& name,
                               const std::vector<std::string>& known) const {
    const InputError error =
        key_error(at(node, key), "unknown key",
                  fmt::format("{}known here: {}", did_you_mean(name, known), fmt::join(known, ", ")));
    throw DocumentedError(Trouble::key, error.where, error.rule, error.mend);
  }

  void read_key(const std::string& key, const toml::node& node) {
    const std::array<std::pair<const char*, std::string*>, 9> words = {{{"number", &out_.number},
                                                                        {"laboratory", &out_.laboratory},
                                                                        {"customer", &out_.customer},
                                                                        {"order", &out_.order},
                                                                        {"valve", &out_.valve},
                                                                        {"place", &out_.place},
                                                                        {"method", &out_.method},
                                                                        {"operator", &out_.person},
                                                                        {"authorised_by", &out_.authorised_by}}};
    for (const auto& [name, value] : words)
      if (key == name) {
        *value = word(node, key);
        return;
      }
    if (key == "date") {
      out_.date = date(node, key);
    } else if (key == "issued") {
      out_.issued = date(node, key);
      issued_at_ = at(node, key);
    } else if (key == "decision") {
      read_decision(node);
    } else if (key == "instrument") {
      const toml::array* all = node.as_array();
      if (!all) throw key_error(at(node, key), "is no list of sections", "write [[instrument]] for each");
      for (const toml::node& one : *all) out_.instruments.push_back(instrument(one));
    } else {
      refuse_key(node, key, key,
                 {"number", "date", "issued", "laboratory", "customer", "order", "valve", "place", "method", "operator",
                  "authorised_by", "[decision]", "[[instrument]]"});
    }
  }

  void read_decision(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (!table) throw key_error(at(node, "decision"), "is not a section", "write it as [decision]");
    for (const auto& [name, value] : *table) {
      const std::string key = "decision." + std::string(name.str());
      if (name.str() != "guard_band") refuse_key(value, key, std::string(name.str()), {"guard_band"});
      const auto band = value.value<double>();
      if (!band || !(*band >= 0 && *band <= 10))
        throw key_error(at(value, key), "is no number from 0 to 10",
                        "give the guard band in expanded uncertainties: 1, or 0 for simple acceptance");
      out_.guard = *band;
    }
  }

  Instrument instrument(const toml::node& node) const {
    Instrument out;
    const toml::table* table = node.as_table();
    if (!table) throw key_error(at(node, "instrument"), "is not a section", "write it as [[instrument]]");
    std::optional<Signal> signal;
    const toml::node* uncertainty = nullptr;
    for (const auto& [name, value] : *table) {
      const std::string key = "instrument." + std::string(name.str());
      if (name.str() == "name")
        out.name = word(value, key);
      else if (name.str() == "serial")
        out.serial = word(value, key);
      else if (name.str() == "calibrated")
        out.calibrated = date(value, key);
      else if (name.str() == "due")
        out.due = date(value, key);
      else if (name.str() == "uncertainty")
        out.uncertainty = word(value, key), uncertainty = &value;
      else if (name.str() == "signal") {
        signal = find_signal(word(value, key));
        if (!signal)
          throw key_error(at(value, key), "unknown signal '" + word(value, key) + "'",
                          "'servodx list signals' names them");
      } else
        refuse_key(value, key, std::string(name.str()),
                   {"name", "serial", "signal", "uncertainty", "calibrated", "due"});
    }
    if (out.name.empty()) throw key_error(at(node, "instrument"), "has no name", "add name = \"pressure sensor A\"");
    if (uncertainty && signal)
      out.error = error_of(*signal, out.uncertainty, at(*uncertainty, "instrument.uncertainty"));
    return out;
  }

  // "0.5 %" of the reading; else a quantity, of which a difference counts: 0.5 degC is 0.5 K.
  static InstrumentError error_of(Signal signal, const std::string& text, const Place& where) {
    InstrumentError error{signal, 0, 0};
    if (text.ends_with('%')) {
      error.relative = parse_quantity(text, Dimension::fraction, where).value;
    } else {
      const Quantity read = parse_quantity(text, info(signal).dimension, where);
      error.absolute = read.value - read.unit->to_si(0);
    }
    if (error.relative < 0 || error.absolute < 0) throw key_error(where, "is negative", "give its size");
    return error;
  }

  Certificate out_;
  Place issued_at_;
};

}  // namespace

std::vector<InstrumentError> Certificate::errors() const {
  std::vector<InstrumentError> all;
  for (const Instrument& i : instruments)
    if (i.error) all.push_back(*i.error);
  return all;
}

const Instrument* Certificate::of(Signal signal) const {
  for (const Instrument& i : instruments)
    if (i.error && i.error->signal == signal) return &i;
  return nullptr;
}

std::vector<std::string> Certificate::overdue() const {
  std::vector<std::string> all;
  for (const Instrument& i : instruments)
    if (i.overdue(date))
      all.push_back(path + ": the calibration of '" + i.name + "' was due on " + i.due + ", before the test of " +
                    date);
  return all;
}

Certificate read_certificate(const std::string& path) {
  try {
    return CertificateReader(path).read();
  } catch (const InputError& error) {
    if (error.where.column.empty()) throw;
    throw_of_key(error);  // quantities are read by who knows of columns only
  }
}

}  // namespace servodx
