#include "report/tune/tune_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/identifiability.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/row_verdict_word.h"
#include "servodx/table.h"
#include "servodx/tune.h"

namespace servodx::report {
namespace {

// A held row has no error of its own; one on a bound was fitted and has none either.
bool was_fitted(const ParameterResult& p) { return std::isfinite(p.std_error) || p.verdict == RowVerdict::at_bound; }

std::string channels_table(const std::vector<ChannelResult>& channels) {
  Columns table("lrrrl", 2);
  table.row({"channel", "rms error", "noise", "held out", "unit"});
  for (const ChannelResult& c : channels) {
    const ChannelFigures f = figures(c);
    table.row({std::string(info(c.signal).name), digits(f.rms), digits(f.noise_rms), digits(f.heldout_rms), f.unit});
  }
  return table.text();
}

std::string parameters_table(const std::vector<ParameterResult>& parameters) {
  Columns table("rlrrrll", 2);
  table.row({"id", "parameter", "nominal", "estimate", "+-", "unit", "verdict"});
  for (const ParameterResult& p : parameters) {
    if (!was_fitted(p)) continue;
    const InHandyUnit in(p);
    table.row({p.id > 0 ? std::to_string(p.id) : "", p.name, in(p.nominal), in(p.estimate), in(p.std_error, 2),
               in.unit.name.empty() ? "-" : in.unit.name, word_of(p.verdict)});
  }
  return table.text();
}

// Why a row that could be free was held: what the logs cannot tell.
std::string held_rows(const std::vector<ParameterResult>& parameters) {
  Columns table("ll", 2);
  for (const ParameterResult& p : parameters) {
    if (was_fitted(p)) continue;
    std::vector<std::string> others;
    for (const std::string& name : p.confounded_with)
      if (std::find(others.begin(), others.end(), name) == others.end()) others.push_back(name);
    const std::string reason = p.verdict == RowVerdict::flat ? "the logs do not show it"
                               : p.verdict == RowVerdict::confounded
                                   ? "the logs show it only together with " + join(others)
                                   : word_of(p.verdict);
    table.row({"held: " + p.name, reason});
  }
  return table.text();
}

}  // namespace

std::string text_of(const TuneResult& result, const GoodEnough& good, const TextOptions& options) {
  const auto fitted = std::count_if(result.parameters.begin(), result.parameters.end(), was_fitted);
  std::string text = fmt::format("{}tuned {} from {}", result.interrupted ? "interrupted, the best so far: " : "",
                                 plural(fitted, "parameter"), plural(static_cast<long>(result.logs.size()), "log"));
  text += options.written_to.empty() ? "\n" : ": " + options.written_to + "\n";
  text += "  good enough?  " + line_of(good) + "\n";
  if (!good.errors.empty()) text += "  " + good.errors + "\n";
  text += "\n" + channels_table(result.channels) + "\n" + parameters_table(result.parameters);
  text += held_rows(result.parameters) + "\n";
  if (!result.starts.empty()) {
    const auto [least, most] = std::ranges::minmax(result.starts, {}, &StartEnd::cost);
    text += fmt::format("  {} of {} reached the best basin; final costs {}{}\n", result.reached_best(),
                        plural(static_cast<long>(result.starts.size()), "start"), digits(least.cost, 4),
                        result.starts.size() > 1 ? " to " + digits(most.cost, 4) : "");
  }
  if (const std::string gains = gains_in_words(result); !gains.empty()) text += "  " + gains + "\n";
  if (const std::string effects = effects_in_words(result.effects); !effects.empty()) text += "  " + effects + "\n";
  Columns nulls("lr", 2);
  for (const LogResult& log : result.logs) nulls.row({"null of " + log.path, percent(log.null) + " of rated"});
  return text + nulls.text();
}

}  // namespace servodx::report
