// The standard figures of a servovalve from a log of a test stand, as SAE ARP490 defines them: an acceptance sheet.
//
// Slow sweeps of the command give the flow, pressure and leakage curves, branch by branch; sine sweeps and noise give
// the frequency response. Currents among the figures are parts of rated current. A branch is the mean of all
// sweeps that way, from three reversals on without the first sweep, which comes from rest. Of a curve that the log
// lacks, only figures with a limit are reported, as not shown; of one that it has, some that cannot be read are
// reported with the reason.
//   rated_flow     mean size of the no-load flow at plus and minus rated current
//   null_bias      current at which the mean of both branches is zero
//   hysteresis     largest difference in current between the branches at one output
//   threshold      change of current after a reversal until the output turns, less what the output's resolution takes
//   linearity      largest departure of the mean curve from its straight line, in current
//   symmetry       difference of the flow gains of the two polarities over the larger
//   lap            distance between the straight parts of both polarities where they meet zero flow
//   pressure_gain  blocked-port load pressure within +-40 % of supply: part of supply per per cent of rated current
//   null_leakage   largest flow from supply to return with the ports blocked; pilot_leakage the least, spool open
// Limits: a sweep that is not slow adds the lag of valve and meter to the hysteresis, and says so; from a fast one
// neither hysteresis nor threshold is read. The uncertainty holds noise, resolution and instruments, and no method.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "curves/frequency_response.h"
#include "servodx/curves.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx::curves {

// One output over the command, both branches and their mean on the same currents; NaN where a branch has no samples.
struct SweepCurve {
  Signal signal;
  std::vector<double> current;         // [A] evenly spaced
  std::vector<double> up, down, mean;  // [SI]
};

// too_near: inside the limit, by less than the guard band. It is no pass.
enum class Judgement { not_judged, pass, too_near, fail };

// Why the log does not tell a figure, or how it was read. In words: report/curves/curves.h.
struct Remark {
  enum class Kind {
    none,
    // Not told.
    too_fast,         // `first`: [1/s] rated current per time that the command sweeps
    one_way,          // the command sweeps
    coarse_readings,  // `first`: [1 of rated current] what they resolve
    short_command,    // `first`, `second`: [% of rated] lowest and highest
    coarse_command,   // `first`: [% of rated] its steps; `second`: [1/%] the least that the gain is
    not_reached,      // `first`: [Hz] up to where the log tells the response
    not_shown,        // nothing in the log is of it
    // How it was read.
    mean_of_reversals,      // `first`: how many; `second`: [1 of rated current] resolved
    brought_to_rated_drop,  // `first`: [Pa] drop that it was taken at; `second`: [Pa] rated
    of_largest_pressure,    // for want of the supply
    positive_is_overlap,    //
    pilot_stage_included,   //
    least_of_sweep,         // with the edges' leakage at its end
    at_half_height,         // of the peak
    at_rated_current        //
  };
  Kind kind = Kind::none;
  double first = 0, second = 0;
};

struct Figure {
  std::string name;    // of limit_list, or a further one
  std::string signal;  // what it was read from
  double value = 0;    // [unit]
  std::string unit;    // SI; "-" for a fraction
  Remark remark = {};
  double uncertainty = std::numeric_limits<double>::quiet_NaN();  // [unit] expanded, k = 2; NaN: not known
  std::optional<Limit> limit = {};
  Judgement judgement = Judgement::not_judged;  // also where the log cannot tell

  std::optional<bool> pass() const {
    return judgement == Judgement::not_judged ? std::nullopt : std::optional(judgement == Judgement::pass);
  }
};

struct Sheet {
  std::vector<Figure> figures;
  std::vector<SweepCurve> curves;
  std::vector<ResponsePoint> response;
  std::string response_signal;
  AcceptanceSheet::Kind verdict = AcceptanceSheet::Kind::not_judged;
  std::vector<Note> notes;
};

// Throws InputError for a log or rig file from which no figure can be read.
Sheet read_curves(const Log& log, const RigFile& rig, const SheetOptions& options = {});

// The figures by themselves, without uncertainty and judgement.
Sheet read_figures(const Log& log, const RigFile& rig);
// Expanded uncertainty of each figure: what noise and resolution do to it, by drawing them again (JCGM 101, propagation
// of distributions), and each error of an instrument. The valve's own scatter from test to test is not in it.
void add_uncertainty(Sheet& sheet, const Log& log, const RigFile& rig, const std::vector<InstrumentError>& instruments);
// Figures that have a limit and are not in the log are added as such.
void judge(Sheet& sheet, const RigFile& rig, double guard);
// One figure that does not pass fails the sheet; it passes only where each limit is judged.
AcceptanceSheet::Kind verdict_of(const std::vector<Figure>& figures);
// Limits of which no figure is judged, by name.
std::vector<std::string> unjudged_limits(const std::vector<Figure>& figures);

}  // namespace servodx::curves
