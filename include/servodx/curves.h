// Curves: the standard figures of a servovalve from a log of a test stand (SAE ARP490). docs/test_stand.md.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx {

namespace curves {
struct Sheet;  // the library's own
using SharedSheet = std::shared_ptr<const Sheet>;
}  // namespace curves

// What is known of an instrument: expanded uncertainty, k = 2, from its calibration.
struct InstrumentError {
  Signal signal;
  double absolute = 0;  // [SI]
  double relative = 0;  // of the reading
};

// A figure passes where it is inside its limit by more than `guard` times its expanded uncertainty; on the limit it
// never does. 0: simple acceptance.
struct SheetOptions {
  std::vector<InstrumentError> instruments = {};
  double guard = 1.0;

  // Throws InputError that names the option.
  void validate() const;
};

struct AcceptanceSheet {
  // incomplete: what is judged passes, and the log does not show the figure of some limit. not_judged: of all, or there
  // are none.
  enum class Kind { pass, fail, not_judged, incomplete };
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
  curves::SharedSheet whole;  // for the program's pages
};

// Throws InputError for a log or rig file from which no figure can be read.
AcceptanceSheet acceptance_sheet(const Log& log, const Rig& rig, const SheetOptions& options = {});

}  // namespace servodx
