#include "report/diagnose/bode_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "fit/bode.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/bode.h"

namespace servodx::report {
namespace {

// Below this the spool stands still, and a phase means nothing.
constexpr double least_gain = -30;  // [dB]

std::string in_hertz(const std::optional<double>& f) { return f ? digits(*f) + " Hz" : "not reached"; }

Plot plot_of(const Bode& bode, const std::string& what, bool last) {
  return {.title = fmt::format("{}, at +-{} of rated current", what, percent(bode.amplitude)),
          .x_label = "frequency [Hz]",
          .x_label_shown = last,
          .x = bode.frequency,
          .group = "bode",
          .log_x = true};
}

}  // namespace

void add_bode(Page& page, const std::vector<Bode>& bodes) {
  TablePart table{"Bandwidth", "llll", {"valve", "sine, of rated", "-3 dB at", "90 deg lag at"}, {}, 0};
  for (const Bode& bode : bodes)
    for (const BodeLine& line : bode.lines) {
      const Bandwidth b = bandwidth_of(bode, line);
      table.rows.push_back(
          {words(line.name), "+-" + percent(bode.amplitude), in_hertz(b.gain_3_db), in_hertz(b.lag_90)});
    }
  page.add(table);
  for (const Bode& bode : bodes) {
    Plot gain = plot_of(bode, "spool over current [dB]", false), phase = plot_of(bode, "phase [deg]", true);
    for (const BodeLine& line : bode.lines) {
      const Role role = &line == &bode.lines.front() ? Role::reference : Role::named;
      Series g{words(line.name), {}, role}, p{words(line.name), {}, role};
      for (std::size_t k = 0; k < line.gain.size(); ++k) {
        const bool moves = line.gain[k] > least_gain;
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        g.y.push_back(moves ? line.gain[k] : none);
        p.y.push_back(moves ? line.phase[k] * 180 / std::numbers::pi : none);
      }
      gain.series.push_back(g), phase.series.push_back(p);
    }
    gain.y_marks = {{-3, "-3 dB"}}, phase.y_marks = {{-90, "-90 deg"}};
    page.add(gain);
    page.add(phase);
  }
}

}  // namespace servodx::report
