// The certificate sheet: what a test certificate says beside the result, of what ISO/IEC 17025 (7.8) asks for:
// laboratory, customer, test, method, instruments with their calibration, the rule by which conformity is stated, and
// who authorised it. Read from a TOML file. docs/results.md says what of 7.8 is left to the laboratory.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "servodx/curves.h"
#include "servodx/log.h"

namespace servodx {

struct Instrument {
  std::string name, serial;
  std::string calibrated, due;           // "2026-05-02"; empty: not said
  std::string uncertainty;               // as written: "0.5 %" of the reading, or a quantity; expanded, k = 2
  std::optional<InstrumentError> error;  // where it names its signal

  bool overdue(const std::string& date) const { return !due.empty() && due < date; }
};

struct Certificate {
  std::string path, sha256;
  std::string number, date, customer, order, valve, place, person;
  std::string issued;                             // a date; empty: not said
  std::string laboratory, method, authorised_by;  // name and address; by what rule it was tested; who answers for it
  double guard = 1.0;                             // guard band, in expanded uncertainties; 0: simple acceptance
  std::vector<Instrument> instruments;

  std::vector<InstrumentError> errors() const;
  const Instrument* of(Signal signal) const;  // null: none is named
  std::vector<std::string> overdue() const;   // in words
};

// Throws InputError with file, line, key, rule and mend.
Certificate read_certificate(const std::string& path);

}  // namespace servodx
