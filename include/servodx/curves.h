// Curves: the standard figures of a servovalve from a log of a test stand (SAE ARP490). docs/test_stand.md.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx {

struct AcceptanceSheet {
  enum class Kind { pass, fail, not_judged };
  struct Figure {
    std::string name, signal;  // what it was read from
    double value = 0;          // [unit]
    std::string unit;          // SI; "-" for a fraction
    double uncertainty = 0;    // [unit] expanded, k = 2; NaN: not known
    std::optional<Limit> limit;
    std::optional<bool> pass;  // empty: no limit, or the log cannot tell; on the limit is no pass
    std::string note;
  };
  // An output over the command, both branches and their mean on the same currents.
  struct Curve {
    Signal signal = Signal::time;
    std::vector<double> current;         // [A]
    std::vector<double> up, down, mean;  // [SI] NaN where a branch has no samples
  };
  struct Response {
    double frequency = 0;  // [Hz]
    double gain = 0;       // output over input
    double phase = 0;      // [rad]
    double coherence = 0;  // 0 to 1
  };
  Kind kind = Kind::not_judged;
  std::vector<Figure> figures;
  std::vector<Curve> curves;
  std::vector<Response> response;
  std::string response_signal;
  std::vector<Note> notes;
};

// Throws InputError for a log or rig file from which no figure can be read.
AcceptanceSheet acceptance_sheet(const Log& log, const Rig& rig);

}  // namespace servodx
