#include "report/explain/explain_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "evidence/conditions.h"
#include "evidence/heldout_gain.h"
#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/healthy.h"
#include "explain/learnt_curves.h"
#include "explain/missing.h"
#include "explain/outcome.h"
#include "explain/show.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "report/explain/explain_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "servodx/log.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx::report {
namespace {

Json to_json(const Interval& i) {
  return {{"value", number(i.value)}, {"lower", number(i.lower)}, {"upper", number(i.upper)}};
}

Json to_json(const ExplainedParameter& p) {
  return {{"value", number(p.value)}, {"std_error", number(p.std_error)}, {"lower", number(p.lower)},
          {"upper", number(p.upper)}, {"told", word_of(p.told)},          {"unit", p.unit}};
}

Json to_json(const ExplainedCause& c) {
  Json parameters = Json::object();
  for (const ExplainedParameter& p : c.parameters) {
    parameters[p.name] = to_json(p);
    parameters[p.name]["before"] = number(p.before);
  }
  return {{"effect", c.effect},
          {"where", c.where},
          {"told_by", word_of(c.told_by)},
          {"parameters", parameters},
          {"heldout_gain", number(c.heldout_gain.value)},
          {"heldout_gain_interval", {number(c.heldout_gain.lower), number(c.heldout_gain.upper)}},
          {"gain_beyond_retuning", to_json(c.beyond_retuning)},
          {"delta_bic", number(c.delta_bic)},
          {"confusable_with", c.confusable_with},
          {"separating_test", c.test}};
}

Json to_json(const LearntCurve& c) {
  Json points = Json::array();
  for (const CurvePoint& p : c.points)
    points.push_back({{"x", number(p.x)}, {"value", number(p.value)}, {"std_error", number(p.std_error)}});
  return {{"where", c.where},
          {"variable", c.variable},
          {"variable_unit", c.variable_unit},
          {"factor", c.factor},
          {"unit", c.unit},
          {"points", points},
          {"closed_form", c.closed_form.empty() ? Json(nullptr) : Json(c.closed_form)}};
}

Json to_json(const ExplainedCandidate& c) {
  return {{"effect", c.effect},
          {"where", c.where},
          {"reason", words_of(c.fate)},
          {"predicted_gain", number(c.predicted_gain)},
          {"p_new", c.p_new ? number(*c.p_new) : Json(nullptr)},
          {"fitted", c.fitted},
          {"heldout_gain", c.fitted ? to_json(c.heldout_gain) : Json(nullptr)},
          {"heldout_share", c.fitted ? to_json(c.share) : Json(nullptr)},
          {"delta_bic", c.fitted ? number(c.delta_bic) : Json(nullptr)}};
}

Json to_json(const ShownChannel& c) {
  Json inputs = Json::array(), spectrum = Json::array(), coherence = Json::array(), maps = Json::array();
  for (const InputCorrelation& i : c.inputs)
    inputs.push_back({{"input", i.input},
                      {"correlation", number(i.correlation)},
                      {"lag_s", number(i.lag)},
                      {"band_99", number(i.band)}});
  for (const auto& [f, v] : c.spectrum) spectrum.push_back({number(f), number(v)});
  for (const auto& [f, v] : c.coherence) coherence.push_back({number(f), number(v)});
  for (const ResidualMap& m : c.maps) {
    Json bins = Json::array();
    for (const MapBin& b : m.bins)
      bins.push_back({{"from", number(b.from)},
                      {"to", number(b.to)},
                      {"mean", number(b.mean)},
                      {"rms", number(b.rms)},
                      {"time_share", number(b.time)},
                      {"excess_share", number(b.excess)}});
    maps.push_back({{"variable", m.variable}, {"unit", m.unit}, {"bins", bins}});
  }
  return {{"signal", c.signal},
          {"si_unit", info(*find_signal(c.signal)).si_unit},
          {"rms", number(c.rms)},
          {"noise_rms", number(c.noise)},
          {"summary", words_of(c.excess)},
          {"memory_s", number(c.memory)},
          {"lags_beyond_band", number(c.beyond_band)},
          {"inputs", inputs},
          {"spectrum", spectrum},
          {"coherence_with_command", coherence},
          {"maps", maps}};
}

Json to_json(const PlaceScore& p) {
  return {{"where", p.where},
          {"variable", p.variable},
          {"gain", number(p.gain)},
          {"p_new", p.p_new ? number(*p.p_new) : Json(nullptr)}};
}

// The likeliest place over time, log by log; of a long log every so many samples.
Json to_json(const MissingInputs& m) {
  constexpr std::size_t most = 1000;
  Json places = Json::array(), logs = Json::array();
  for (const MissingInput& p : m.places)
    places.push_back({{"where", p.where},
                      {"quantity", p.quantity},
                      {"unit", p.unit},
                      {"rms", number(p.rms)},
                      {"std_error", number(p.std_error)},
                      {"gain", number(p.gain)},
                      {"likely", p.likely},
                      {"follows", p.variable},
                      {"share", number(p.share)}});
  if (!m.places.empty() && m.places.front().likely)
    for (std::size_t l = 0; l < m.time.size(); ++l) {
      Json time = Json::array(), value = Json::array(), error = Json::array();
      const std::size_t stride = 1 + m.time[l].size() / most;
      for (std::size_t k = 0; k < m.time[l].size(); k += stride) {
        time.push_back(number(m.time[l][k]));
        value.push_back(number(m.places.front().value[l][k])), error.push_back(number(m.places.front().error[l][k]));
      }
      logs.push_back({{"time", time}, {"value", value}, {"std_error", error}});
    }
  return {{"places", places}, {"logs", logs}};
}

Json to_json(const BlockReplay& b) {
  return {{"block", b.block},      {"places", b.places},       {"missing", b.quantity},
          {"unit", b.unit},        {"rms", number(b.missing)}, {"passing_rms", number(b.passing)},
          {"follows", b.variable}, {"share", number(b.share)}, {"p_new", b.p_new ? number(*b.p_new) : Json(nullptr)}};
}

template <class Results>
Json array_of(const Results& results) {
  Json array = Json::array();
  for (const auto& r : results) array.push_back(to_json(r));
  return array;
}

std::string gain_text(const Interval& g) {
  return fmt::format("{} of the held-out misfit ({} to {}, 90 %)", percent(g.value), percent(g.lower),
                     percent(g.upper));
}

// A channel's figures in the unit of the log where it has one.
ChannelFigures in_log_unit(const ExplainedChannel& c, double a, double b, double d) {
  return figures(ChannelResult{*find_signal(c.signal), c.unit, a, b, d});
}

void add_causes(std::string& text, const std::vector<ExplainedCause>& causes) {
  for (const ExplainedCause& c : causes) {
    text += fmt::format("  {} at {}: removes {}{}\n", c.effect, c.where, gain_text(c.heldout_gain),
                        words_of_share(c.told_by));
    for (const ExplainedParameter& p : c.parameters) {
      if (c.curve) break;  // its numbers stand as a curve below
      text += fmt::format("    {} {}, before {}\n", p.name, size_in_words(p), handy(p.before, p.unit));
    }
    if (!c.confusable_with.empty()) text += "    or else " + join(c.confusable_with) + "\n";
    if (!c.test.empty()) text += "    to separate: " + c.test + "\n";
  }
}

Json to_json(const ExplainSuspicion& s) {
  Json size = nullptr;
  if (s.size) {
    size = to_json(*s.size);
    size["name"] = s.size->name;
  }
  return {{"name", s.effect},
          {"where", s.where},
          {"severity", size},
          {"heldout_gain", to_json(s.share)},
          {"rate", number(s.rate)},
          {"logs", s.logs},
          {"logs_needed", s.logs_needed > 0 ? Json(s.logs_needed) : Json(nullptr)}};
}

Json to_json(const ExplainedFalseAlarm& f) {
  return {{"asked", f.asked},
          {"promised", f.promised},
          {"logs", f.logs},
          {"alike", f.alike},
          {"statement", rate_in_words(f)}};
}

Json to_json(const ExplainedProbabilities& p) {
  Json out = Json::object();
  for (const ExplainedProbability& c : p.causes) out[c.cause] = number(c.value);
  out["unlisted"] = number(p.unlisted), out["nothing"] = number(p.nothing);
  return out;
}

// More logs, or why these do not help.
std::string logs_words(int logs_needed) {
  if (logs_needed > 0) return fmt::format("{} healthy logs like these would decide it", logs_needed);
  return "more healthy logs like these would not decide it";
}

}  // namespace

std::string size_in_words(const ExplainedParameter& p) {
  if (p.told == SizeTold::interval) return handy_interval(p.value, p.lower, p.upper, p.unit, 90);
  return handy(p.value, p.unit) + ", " + words_of(p.told);
}

std::string rate_in_words(const ExplainedFalseAlarm& f) {
  std::string text = fmt::format("a healthy log is called wrong at a rate of {}, {} {} healthy logs can promise",
                                 percent(f.promised), f.alike ? "that" : "as for tests like their own", f.logs);
  if (f.promised > f.asked) text += fmt::format("; asked was {}", percent(f.asked));
  if (!f.alike) text += "; none of them is of such a test: names need more here, and the rate is an assumption";
  return text;
}

std::string suspicion_in_words(const ExplainSuspicion& s) {
  std::string size;
  if (s.size) size = fmt::format(", {} {}", s.size->name, size_in_words(*s.size));
  return fmt::format(
      "first stands {} at {}{}: it removes {} of the held-out misfit{}, not beyond what {} healthy logs can exclude; "
      "it "
      "would be said at a rate of {} false alarms; {}",
      s.effect, s.where, size, percent(s.share.value), s.of_sensor ? " of its channel" : "", s.logs, percent(s.rate),
      logs_words(s.logs_needed));
}

Json explain_json(const ExplainResult& r) {
  Json channels = Json::array();
  for (const ExplainedChannel& c : r.channels) {
    const ChannelFigures f = in_log_unit(c, c.rms_before, c.noise_rms, c.heldout_before);
    const ChannelFigures g = in_log_unit(c, c.rms_after, c.noise_rms, c.heldout_after);
    channels.push_back({{"signal", c.signal},
                        {"unit", f.unit},
                        {"rms_before", number(f.rms)},
                        {"rms_after", number(g.rms)},
                        {"noise_rms", number(f.noise_rms)},
                        {"heldout_before", number(f.heldout_rms)},
                        {"heldout_after", number(g.heldout_rms)}});
  }
  return {{"verdict", word_of(r.verdict)},
          {"where", r.where.empty() ? Json(nullptr) : Json(r.where)},
          {"depends_on", r.depends_on.empty() ? Json(nullptr) : Json(r.depends_on)},
          {"channels", channels},
          {"causes", array_of(r.causes)},
          {"standing", array_of(r.standing)},
          {"candidates", array_of(r.candidates)},
          {"false_alarm", r.false_alarm ? to_json(*r.false_alarm) : Json(nullptr)},
          {"suspicion", r.suspicion ? to_json(*r.suspicion) : Json(nullptr)},
          {"probabilities", r.probabilities ? to_json(*r.probabilities) : Json(nullptr)},
          {"table_withheld", r.worse_withheld},
          {"heldout_gain", r.causes.empty() ? Json(nullptr) : to_json(r.heldout_gain)},
          {"residuals", array_of(r.shown)},
          {"blocks", array_of(r.blocks)},
          {"places", array_of(r.places)},
          {"missing_input", to_json(r.missing)},
          {"curve", r.curve ? to_json(*r.curve) : Json(nullptr)},
          {"retuned_alone", to_json(r.retuned)},
          {"adequacy",
           {{"before", number(r.adequacy_before)},
            {"after", number(r.adequacy_after)},
            {"p_value", r.p_adequacy ? number(*r.p_adequacy) : Json(nullptr)}}},
          {"interrupted", r.interrupted}};
}

std::string missing_in_words(const ExplainResult& r) {
  const MissingInputs& m = r.missing;
  constexpr double follows = 0.2;  // of its square, to be worth a word
  const auto named = [](const MissingInput& p) {
    return p.where == "drive" || p.quantity != "force" ? p.where + " (" + p.quantity + ")" : p.where;
  };
  if (r.verdict == ExplainVerdict::sufficient || m.places.empty() || !m.places.front().likely) return {};
  const MissingInput& p = m.places.front();
  std::string text =
      fmt::format("missing at {}: {} rms +- {}", named(p), handy(p.rms, p.unit), handy(p.std_error, p.unit));
  if (p.share > follows) text += fmt::format(", {} of its square in line with {}", percent(p.share), p.variable);
  std::vector<std::string> others;
  for (std::size_t k = 1; k < m.places.size(); ++k)
    if (m.places[k].likely)
      others.push_back(fmt::format("{} at {}", handy(m.places[k].rms, m.places[k].unit), named(m.places[k])));
  if (!others.empty()) text += "; these channels do not distinguish it from " + join(others, " or ");
  return text;
}

std::string text_of(const ExplainResult& r, const TextOptions& options) {
  std::string text = word_of(r.verdict);
  if (r.verdict == ExplainVerdict::sufficient)
    text += ": nothing is wrong that healthy logs do not show or that a cause in the list explains";
  if (r.verdict == ExplainVerdict::unexplained)
    text += r.curve ? ": no cause in the list explains it; a learnt curve does"
                    : ": something is wrong, and no cause in the list explains it";
  if (!r.curve && !r.depends_on.empty()) text += "; at " + r.where + " it follows " + r.depends_on;
  if (r.verdict == ExplainVerdict::extended) {
    text += ": ";
    for (std::size_t k = 0; k < r.causes.size(); ++k) text += (k ? ", " : "") + r.causes[k].effect;
  }
  if (!options.written_to.empty()) text += "; " + options.written_to;
  text += "\n";
  if (r.suspicion) text += "  " + suspicion_in_words(*r.suspicion) + "\n";
  if (r.false_alarm) text += "  " + rate_in_words(*r.false_alarm) + "\n";
  if (r.worse_withheld)
    text +=
        "  the simulation's held-out rms is worse with it: the table is written as tuned; --keep-worse writes the "
        "extension all the same\n";
  Columns table("lrrrrrl", 2);
  table.row({"channel", "rms before", "after", "noise", "held out", "after", "unit"});
  for (const ExplainedChannel& c : r.channels) {
    const ChannelFigures f = in_log_unit(c, c.rms_before, c.noise_rms, c.heldout_before);
    const ChannelFigures g = in_log_unit(c, c.rms_after, c.noise_rms, c.heldout_after);
    table.row({c.signal, digits(f.rms), digits(g.rms), digits(f.noise_rms), digits(f.heldout_rms),
               digits(g.heldout_rms), f.unit});
  }
  text += table.text();
  for (const ShownChannel& c : r.shown) {
    const ChannelFigures f = figures(ChannelResult{*find_signal(c.signal), c.unit, c.rms, c.noise, c.rms});
    text += fmt::format("  {}: {} {} rms, noise {}; {}\n", c.signal, digits(f.rms), f.unit, digits(f.noise_rms),
                        words_of(c.excess));
  }
  for (const BlockReplay& b : r.blocks)
    text += fmt::format("  {}: misses {} rms of {}{}{}\n", b.block, handy(b.missing, b.unit), handy(b.passing, b.unit),
                        b.share > 0.2 ? fmt::format(", {} of it in line with {}", percent(b.share), b.variable) : "",
                        b.p_new ? ", p = " + digits(*b.p_new, 2) : "");
  if (const std::string line = missing_in_words(r); !line.empty()) text += "  " + line + "\n";
  text += "  re-tuning alone removes " + gain_text(r.retuned) + "\n";
  add_causes(text, r.causes);
  if (r.curve) {
    text += fmt::format("  learnt in {}, against {}{}:\n", r.curve->where, r.curve->variable,
                        r.curve->factor.empty() ? "" : ", by " + r.curve->factor);
    Columns curve("rrr", 4);
    curve.row({r.curve->variable_unit, r.curve->unit, "+-"});
    for (const CurvePoint& p : r.curve->points) curve.row({digits(p.x), digits(p.value), digits(p.std_error, 2)});
    text += curve.text();
    if (!r.curve->closed_form.empty()) text += "    in short: " + r.curve->closed_form + "\n";
    if (r.where != r.curve->where)
      text += "    rather at " + r.where + ": a name there that leaves the logs abnormal does better than the curve\n";
  }
  if (!r.standing.empty()) text += "  found on healthy logs too:\n";
  add_causes(text, r.standing);
  Columns tried("llrrl", 2);
  tried.row({"tried", "where", "predicted gain", "p", "why not"});
  int shown = 0;
  for (const ExplainedCandidate& c : r.candidates) {
    if (is_taken(c.fate) || ++shown > 6) continue;
    tried.row({c.effect, c.where, digits(c.predicted_gain), c.p_new ? digits(*c.p_new, 2) : "", words_of(c.fate)});
  }
  return text + tried.text();
}

Json healthy_json(const HealthyReference& healthy) {
  Json logs = Json::array();
  for (const HealthyLog& l : healthy.logs) {
    Json scores = Json::array();
    for (const HealthyScore& s : l.scores) {
      Json sizes = Json::array();
      for (const ProbeScore& p : s.sizes) sizes.push_back({number(p.size), number(p.std_error)});
      scores.push_back(
          {{"effect", s.effect}, {"where", s.where}, {"gain", number(s.gain)}, {"prior", s.prior}, {"sizes", sizes}});
    }
    Json misses = Json::object();
    for (const Miss& m : l.misses) misses[m.part] = number(m.size);
    Json shares = Json::array();
    for (const HealthyShare& h : l.shares)
      shares.push_back({{"effect", h.effect},
                        {"where", h.where},
                        {"share", number(h.share)},
                        {"lower", number(h.lower)},
                        {"prior", h.prior}});
    Json errors = Json::array();
    for (const UsualError& e : l.errors)
      errors.push_back({{"signal", e.signal},
                        {"size", number(e.size)},
                        {"memory", number(e.memory)},
                        {"effective", number(e.effective)},
                        {"rate", number(e.rate)}});
    logs.push_back({{"log", l.log},
                    {"sha256", l.sha256},
                    {"other", l.other},
                    {"test", l.test ? test_json(*l.test) : Json(nullptr)},
                    {"errors", errors},
                    {"air_fraction", number(l.air)},
                    {"command_slope", number(l.command_slope)},
                    {"drive_delay", number(l.drive_delay)},
                    {"adequacy", number(l.adequacy)},
                    {"thickness", number(l.scores.empty() ? std::nan("") : l.scores.front().thickness)},
                    {"scores", scores},
                    {"misses", misses},
                    {"shares", shares}});
  }
  return {{"logs", logs}};
}

}  // namespace servodx::report
