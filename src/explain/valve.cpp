#include "explain/valve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/student.h"
#include "effects/armature_angle.h"
#include "effects/edge_transition.h"
#include "effects/effect.h"
#include "effects/flow_meter_lag.h"
#include "effects/line_inertia.h"
#include "effects/mains_pickup.h"
#include "effects/mount_compliance.h"
#include "effects/nozzle_land.h"
#include "effects/orifice_length.h"
#include "effects/registry.h"
#include "effects/rod_cavity.h"
#include "effects/row_effects.h"
#include "effects/screen_drop.h"
#include "effects/seal_shear.h"
#include "effects/sensor_response.h"
#include "effects/stiction.h"
#include "effects/unexplained.h"
#include "effects/viscosity_change.h"
#include "explain/ties.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/thin.h"
#include "fit/tuned_state.h"
#include "optimise/problem.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// The logs are of the rig that was tuned: its rows are known as well as the tuned table says, and not better than this
// part of their range. Freed further, they take up what a missing effect does, differently on every log.
constexpr double least_sd = 2e-3;
constexpr double wide_sd = 0.1;  // re-tuning alone, to compare with
constexpr double longest_memory = 1 - 1e-6;
constexpr double slack = 10;       // an effect may grow beyond what this rig shows when healthy by this
constexpr double row_prior = 0.1;  // a row that was held for a reason, beside an effect that has a name
// Of the construction, there from the first day or never: in a rig's healthy logs as well, and no likely news.
const std::set<std::string> built_in = {ArmatureAngle::name, RodCavity::name,  EdgeTransition::name,
                                        OrificeLength::name, ScreenDrop::name, NozzleLand::name,
                                        SealShear::name};

// Rows that an effect takes along; `grows`: they are a size of it, and no mere part of its shape.
struct Along {
  std::string_view effect;
  int row;
  bool grows;
};
constexpr Along rows_along[] = {
    {Stiction::name, row::spool_friction, true},        // what sticks also drags: silt and lacquer
    {MountCompliance::name, row::moving_mass, false}};  // structure that gives way swings with the rod

// What shows a cause best.
const std::map<std::string, const char*> tests = {
    {"stiction", "slow small triangle: the spool stands still at each reversal, longer the slower"},
    {"magnetic_hysteresis", "slow triangles of several amplitudes: a loop of the same width at any rate"},
    {"armature_angle", "full steps both ways: how long the spool slews before it slows down"},
    {"transport_delay", "steps and a multisine: lag in proportion to frequency, no loss of amplitude"},
    {"mount_compliance", "steps into a stiff load: the body's resonance in the load pressure"},
    {"mains_pickup", "rest: a line at the mains frequency with the valve still"},
    {"viscosity_change", "the same test in cold and in hot oil"},
    {"edge_transition",
     "slow triangles of some per cent in cold and in hot oil: in the cold the piston lags by a wider lap"},
    {"orifice_length", "full steps in cold and in hot oil: in the cold the spool slews slower"},
    {"nozzle_land", "slow triangles in cold and in hot oil with pilot pressures: in the cold they rise"},
    {"seal_shear", "the same fast strokes in cold and in hot oil"},
    {"screen_drop", "full steps in cold and in hot oil: in the cold the pilot pressures fall"},
    {"edge_radius", "the pressure's slope at null beside the leakage there: blunt edges leak more at the same slope"},
    {LineInertia::name,
     "fast steps with taps at the valve and at the cylinder: the two part by the piston's acceleration"},
    {"port_line", "leakage sweeps at two rates, ports blocked: a tail after null that lasts as long at either"},
    {"supply_droop", "full steps with the supply pressure measured at the valve"},
    {"stribeck_friction", "slow ramps through standstill, both ways"},
    {"asymmetric_lap", "slow triangle about null with ports loaded"},
    {"hose_compliance", "steps against a blocked piston"},
    {"air_entrainment", "steps at low and at high mean pressure: air is stiff under pressure, a hose is not"},
    {"cross_piston_leakage", "hold a load: the piston creeps in proportion to the load pressure"},
    {"sensor_lag", "a fast sine: the sensor lags in proportion to frequency"},
    {"sensor_gain_error", "full strokes against a second reference"},
    {"flow_force", "full opening at several pressure drops"},
};

const char* place_of_row(int at) {
  switch (at) {
    case row::driver_bandwidth:
    case row::current_limit:
    case row::servovalve_null:
      return "drive";
    case row::piston_area_a:
    case row::piston_area_b:
    case row::moving_mass:
    case row::piston_viscous_friction:
    case row::piston_coulomb_friction:
    case row::piston_stribeck_friction:
      return "piston_force";
    case row::dead_volume_b:
      return "flow_b";
    case row::position_sensor_lag:
    case row::position_sensor_gain:
      return "sensor:piston_position";
    case row::supply_pressure:
    case row::return_pressure:
      return "supply";
    default:
      break;
  }
  if (at < row::spool_diameter) return "first_stage";
  if (at < row::port_width) return "spool";
  if (at < row::piston_area_a || at == row::hose_resistance) return "metering";
  return "flow_a";
}

// All samples of a sweep on a stand count alike, as in `tune`.
void make_alike(std::vector<double>& sigma) {
  double square = 0;
  for (double s : sigma) square += s * s;
  std::fill(sigma.begin(), sigma.end(), std::sqrt(square / static_cast<double>(sigma.size())));
}

// Laps, corners and hysteresis are about a per cent of rated current wide: so finely a sweep tells them apart.
constexpr double sweep_detail = 0.01;  // of rated current
double travel_of(const Scenario& s) {
  double sum = 0;
  for (std::size_t k = 1; k < s.command.size(); ++k) sum += std::abs(s.command[k] - s.command[k - 1]);
  return sum / s.rated_current;
}

// What healthy logs have had of a nuisance, by Student's 99 %, is where it goes; beyond is a cause, and no log's own
// affair. A log's air is a number of its oil, and counts by how soft it makes it: little air and none are alike. The
// command between samples is the logger's, and a delay in its place.
void limit(FreeValue& own, const std::vector<double>& healthy) {
  if (healthy.size() < 3) return;
  double mean = 0, square = 0;
  const auto n = static_cast<double>(healthy.size());
  for (double v : healthy) mean += v / n;
  for (double v : healthy) square += std::pow(v - mean, 2) / (n - 1);
  const double reach = student_quantile(0.01, n - 1) * std::sqrt(square * (1 + 1 / n)),
               least = 1e-3 * (own.upper - own.lower);
  own.lower = std::max(own.lower, mean - reach);
  own.upper = std::max(std::min(own.upper, mean + reach), own.lower + least);
  own.start = std::clamp(own.start, own.lower, own.upper);
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0 : 0.5 * (v[v.size() / 2] + v[(v.size() - 1) / 2]);
}
double rate_of(const std::vector<double>& time) {
  return static_cast<double>(time.size() - 1) / (time.back() - time.front());
}

void scale_air(double* candidate, double factor) { candidate[row::air_fraction] *= factor; }

// Sizes at which a score looks: some about the present value.
std::vector<double> sizes_about(const Number& n, std::vector<double> moves) {
  std::vector<double> out;
  for (double v : moves)
    if (v >= n.lower && v <= n.upper && v != n.off && std::find(out.begin(), out.end(), v) == out.end())
      out.push_back(v);
  return out;
}

}  // namespace

ValveSubject::ValveSubject(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads,
                           std::optional<KnownRig> known)
    : table_(tuned), base_(candidate_of(tuned)), error_(error_model_of(tuned)), known_(std::move(known)) {
  if (error_.channels.empty())
    throw InputError({.file = tuned.path}, "the table does not say how wrong its model is",
                     "make it with 'servodx tune'; the file then carries lines '#% ...' ahead of its header");
  options_.threads = threads;
  options_.creep_step = creep_step_of(logs, rig);
  RigFile without_notch = rig;
  without_notch.mains_frequency.reset();
  for (const Log& log : logs) {
    logs_.push_back(prepare_thinned(log, without_notch, moving_average_of(tuned)));
    for (std::string& note : leave_out_unknown_channels(logs_.back(), error_))
      logs_.back().notes.push_back(std::move(note));
    require_channels(logs_.back());
  }
  add_causes(rig);
  for (std::size_t l = 0; l < logs_.size(); ++l)
    for (FreeValue& f : nuisance_values(logs_[l], static_cast<int>(l), base_, rig.null_limit)) {
      if (known_ && f.at == row::air_fraction) limit(f, known_->air);
      if (known_ && f.at == nuisance::command_slope) limit(f, known_->command_slope);
      free_.push_back(std::move(f));
    }
  own_ = free_.size();
  for (FreeValue& f : shared_values(table_)) {
    if (f.at >= n_parameters) continue;  // effects of the table are causes
    const Row& row = table_[f.at];
    const double slope = coordinate(row).slope(row.nominal);
    f.prior_sd = std::max(least_sd, row.std_error.value_or(0.0) / slope);
    free_.push_back(std::move(f));
  }
  // Whitening: the model's own error where things move, and the sensor's noise.
  std::vector<const LogData*> data;
  for (const LogData& l : logs_) data.push_back(&l);
  FitProblem whole(data, base_, free_, options_);
  apply_error_model(whole, error_, whole.start());
  long first = 0;
  for (std::size_t l = 0; l < logs_.size(); ++l) {
    auto& sigmas = sigma_.emplace_back();
    for (std::size_t c = 0; c < logs_[l].channels.size(); ++c) {
      sigmas.push_back(whole.sigma(static_cast<int>(l), static_cast<int>(c)));
      if (of_stand(l)) make_alike(sigmas.back());
    }
  }
  for (std::size_t l = 0; l < logs_.size(); ++l)
    for (std::size_t c = 0; c < logs_[l].channels.size(); ++c) {
      const FitChannel& channel = logs_[l].channels[c];
      const ChannelError* e = error_.find(channel.signal);
      const auto n = static_cast<long>(channel.measured.size());
      series_.push_back({std::string(info(channel.signal).name), std::string(info(channel.signal).si_unit),
                         static_cast<int>(l), first, n, &logs_[l].scenario.time, &sigma_[l][c], channel.noise,
                         effective_of(e, logs_[l].scenario.time)});
      first += n;
      auto& tuned_sigma = tuned_sigma_.emplace_back(sigma_[l][c]);
      for (double& v : tuned_sigma) v *= std::sqrt(series_.back().effective);
      memory_.push_back(0.0);
      auto& afresh = afresh_.emplace_back(channel.measured.size(), 0);
      for (std::size_t k = 0; k < afresh.size(); ++k)
        afresh[k] = k == 0 || std::isnan(channel.measured[k]) || std::isnan(channel.measured[k - 1]);
    }
}

int ValveSubject::add(Cause cause, std::vector<FreeValue> values) {
  if (const auto it = tests.find(cause.effect); it != tests.end() && cause.test.empty()) cause.test = it->second;
  causes_.push_back(std::move(cause));
  values_.push_back(std::move(values));
  return static_cast<int>(causes_.size()) - 1;
}

void ValveSubject::add_causes(const RigFile& rig) {
  const auto number_of = [](const FreeValue& f, const std::string& unit, bool size) {
    return Number{f.name, unit, f.lower, f.upper, f.log_scale, f.start, size, ""};
  };
  // One alternative a size of one number, the rest as they are; and all together where there are several.
  const auto finish = [&](Cause cause, std::vector<FreeValue> values, const std::vector<std::vector<double>>& sizes) {
    std::vector<double> rest;
    for (const FreeValue& f : values) rest.push_back(f.start);
    std::vector<std::vector<double>> together;
    for (std::size_t j = 0; j < sizes.size(); ++j)
      for (std::size_t k = 0; k < sizes[j].size(); ++k) {
        std::vector<double> probe = rest;
        probe[j] = sizes[j][k];
        cause.probes.push_back({probe});
        if (k == 0) together.push_back(probe);
      }
    if (together.size() > 1) cause.probes.push_back(together);
    if (!cause.probes.empty()) add(std::move(cause), std::move(values));
  };
  const auto shown = [&](Signal s) {
    return std::any_of(logs_.begin(), logs_.end(), [&](const LogData& l) {
      return std::any_of(l.channels.begin(), l.channels.end(), [&](const FitChannel& c) { return c.signal == s; });
    });
  };

  const bool on_stand =
      std::any_of(logs_.begin(), logs_.end(), [](const LogData& l) { return l.scenario.ports != Ports::actuator; });
  const bool oil_known = std::all_of(logs_.begin(), logs_.end(), [](const LogData& l) { return l.scenario.oil_known; });

  // Sensors and clocks are suspects before physics.
  for (const EffectInfo& e : effect_list()) {
    const auto value_of = [&](int j) {
      const EffectParameter& p = e.parameters[static_cast<std::size_t>(j)];
      const int at = e.first + j;
      const double v = base_[static_cast<std::size_t>(at)];
      const double upper = p.switches && p.off == p.lower ? std::max(p.upper, slack * v) : p.upper;
      return FreeValue{p.name, at, std::min(p.lower, v), std::max(upper, v), false, v};
    };
    if (e.name == MainsPickup::name) {
      constexpr Signal signals[MainsPickup::sensors] = {Signal::spool_position, Signal::piston_position,
                                                        Signal::pressure_a, Signal::pressure_b};
      for (int c = 0; c < MainsPickup::channels; ++c) {
        const bool of_sensor = c < MainsPickup::sensors;
        if (of_sensor && !shown(signals[c])) continue;
        Cause cause;
        cause.effect = e.name;
        cause.where = of_sensor ? "sensor:" + std::string(info(signals[c]).name) : "drive";
        std::vector<FreeValue> values = {value_of(2 * MainsPickup::channels + c)};
        cause.numbers.push_back(number_of(values[0], "Hz", false));
        std::vector<double> rest = {values[0].start};
        for (std::size_t l = 0; l < logs_.size(); ++l)
          for (int k : {2 * c, 2 * c + 1}) {
            FreeValue f = value_of(k);
            f.log = static_cast<int>(l);  // the phase belongs to a log
            cause.numbers.push_back(number_of(f, e.parameters[static_cast<std::size_t>(k)].unit, true));
            rest.push_back(f.start);
            values.push_back(std::move(f));
          }
        std::vector<double> frequencies = {50.0, 60.0};
        if (rig.mains_frequency) frequencies = {*rig.mains_frequency};
        for (double f : frequencies)
          for (double off : {0.0, -0.15, 0.15}) {
            std::vector<std::vector<double>> together;
            for (std::size_t j = 1; j < rest.size(); ++j) {
              std::vector<double> probe = rest;
              probe[0] = f + off;
              probe[j] += e.parameters[static_cast<std::size_t>(2 * c)].start;
              together.push_back(std::move(probe));
            }
            cause.probes.push_back(std::move(together));
          }
        add(std::move(cause), std::move(values));
      }
      continue;
    }
    // Gain and lag of a sensor carry one name whichever file has them.
    const auto add_sensor = [&](int j, int shown_at, const char* effect) {
      const Signal signal = simulated_signals[static_cast<std::size_t>(shown_at)];
      if (!shown(signal)) return;
      const FreeValue f = value_of(j);
      const EffectParameter& p = e.parameters[static_cast<std::size_t>(j)];
      Cause cause;
      cause.effect = effect;
      cause.where = "sensor:" + std::string(info(signal).name);
      cause.numbers = {number_of(f, p.unit, true)};
      const double move = p.start - p.off;
      finish(std::move(cause), {f},
             {sizes_about(number_of(f, p.unit, true), {f.start + move, f.start - move, f.start + 4 * move})});
    };
    if (e.name == SensorResponse::name) {
      for (int c = 0; c < SensorResponse::channels; ++c) {
        add_sensor(2 * c, SensorResponse::shown_at[c], "sensor_gain_error");
        add_sensor(2 * c + 1, SensorResponse::shown_at[c], "sensor_lag");
      }
      continue;
    }
    if (e.name == FlowMeterLag::name) {
      for (int k = 0; k < FlowMeterLag::n_parameters; ++k) add_sensor(k, FlowMeterLag::shown_at[k], "sensor_lag");
      continue;
    }
    if (e.name == Unexplained::name || e.shapes_rows || e.as_made || (e.stand_only && !on_stand)) continue;
    if (e.name == ViscosityChange::name && !oil_known) continue;  // each log's own
    Cause cause;
    cause.effect = e.name;
    cause.where = e.place;
    if (known_ && built_in.contains(e.name)) cause.prior = row_prior;
    std::vector<FreeValue> values;
    std::vector<std::vector<double>> sizes;
    std::vector<std::pair<std::size_t, double>> typical;  // shapes that the table has otherwise
    for (std::size_t j = 0; j < e.parameters.size(); ++j) {
      const EffectParameter& p = e.parameters[j];
      FreeValue f = value_of(static_cast<int>(j));
      const int in_table = table_.find(p.name);
      // What grows is the size. A shape that was found in tuning is this valve's own; let go, it takes on what any
      // other cause does.
      if (!p.switches && in_table >= 0 && table_[in_table].std_error) continue;
      if (!p.switches && in_table < 0) f.start = p.start;
      if (!p.switches && f.start != p.start) typical.emplace_back(values.size(), p.start);
      cause.numbers.push_back(number_of(f, p.unit, p.switches));
      sizes.emplace_back();
      if (p.switches) {
        const double move = p.start - p.off, v = f.start;
        sizes.back() = sizes_about(cause.numbers.back(),
                                   {v + move, v + 0.25 * move, v + 4 * move, v + 16 * move, v - 0.25 * move, v - move});
      }
      values.push_back(std::move(f));
    }
    for (const Along& along : rows_along) {
      if (e.name != along.effect) continue;
      const Row& r = table_[along.row];
      values.push_back(
          {r.name, along.row, std::min(r.lower, r.nominal), std::max(r.upper, r.nominal), r.log_scale, r.nominal});
      cause.numbers.push_back(number_of(values.back(), r.unit, along.grows));
      sizes.push_back(along.grows ? sizes_about(cause.numbers.back(), {2 * r.nominal, 5 * r.nominal})
                                  : std::vector<double>{});
    }
    finish(std::move(cause), values, sizes);
    // A shape that the table has, and no log has shown, may suit what it had to imitate: the typical one is tried as
    // well.
    Cause& added = causes_.back();
    const auto probes = added.probes;
    for (const auto& [j, start] : typical)
      for (const auto& alternative : probes) {
        added.probes.push_back(alternative);
        for (auto& probe : added.probes.back()) probe[j] = start;
      }
  }

  // Rows.
  const auto row_value = [&](int at) {
    const Row& r = table_[at];
    return FreeValue{r.name, at, std::min(r.lower, r.nominal), std::max(r.upper, r.nominal), r.log_scale, r.nominal};
  };
  const auto row_sizes = [](const Number& n) {
    const double u = n.to_unit(n.off);
    std::vector<double> out;
    for (double du : {0.05, -0.05, 0.25, -0.25})
      if (u + du >= 0 && u + du <= 1) out.push_back(n.from_unit(u + du));
    return out;
  };
  std::vector<char> named(n_parameters, 0);
  for (const RowEffect& e : row_effects()) {
    Cause cause;
    cause.effect = e.name;
    cause.where = e.where;
    std::vector<FreeValue> values;
    std::vector<std::vector<double>> sizes;
    for (int at : e.rows) {
      named[static_cast<std::size_t>(at)] = 1;
      FreeValue f = row_value(at);
      if (at == row::air_fraction) {
        f = FreeValue{"air_fraction", at, 0.02, 50.0, true, 1.0};
        f.apply = &scale_air;
        cause.atop = table_[at].name;
      }
      cause.numbers.push_back(number_of(f, table_[at].unit, true));
      sizes.push_back(at == row::air_fraction ? std::vector<double>{2.0, 0.5, 8.0} : row_sizes(cause.numbers.back()));
      cause.numbers.back().upper = f.upper = std::max(f.upper, e.worst);
      values.push_back(std::move(f));
    }
    for (const int at : e.shapes) {
      const EffectParameter& p = parameter_at(at);
      FreeValue f{p.name, at, p.lower, p.upper, true, table_.find(p.name) >= 0 ? base_[at] : p.start};
      cause.numbers.push_back(number_of(f, p.unit, false));
      sizes.emplace_back();
      values.push_back(std::move(f));
    }
    finish(std::move(cause), std::move(values), sizes);
  }
  const auto logged = [&](auto member) {
    return std::all_of(logs_.begin(), logs_.end(), [&](const LogData& l) { return !(l.scenario.*member).empty(); });
  };
  for (int at = 0; at < n_parameters; ++at) {
    const Row& r = table_[at];
    if (named[static_cast<std::size_t>(at)] || !(r.upper > r.lower) || at == row::servovalve_null) continue;
    if (at == row::supply_pressure && logged(&Scenario::supply_pressure)) continue;
    if (at == row::return_pressure && logged(&Scenario::return_pressure)) continue;
    Cause cause;
    cause.effect = r.name;
    cause.where = place_of_row(at);
    cause.prior = row_prior;
    const FreeValue f = row_value(at);  // one that is tuned is let go of what tuning knows
    cause.numbers = {number_of(f, r.unit, true)};
    const auto sizes = row_sizes(cause.numbers.back());
    finish(std::move(cause), {f}, {sizes});
  }
}

std::shared_ptr<FitProblem> ValveSubject::problem(const std::vector<int>& causes, bool wide) const {
  std::vector<FreeValue> free(free_.begin(), free_.begin() + static_cast<long>(base_count(wide)));
  for (FreeValue& f : free)
    if (wide && f.log < 0) f.prior_sd = wide_sd;
  for (int c : causes)
    for (const FreeValue& f : values_[static_cast<std::size_t>(c)]) free.push_back(f);
  std::vector<const LogData*> data;
  for (const LogData& l : logs_) data.push_back(&l);
  const auto p = std::make_shared<FitProblem>(data, base_, std::move(free), options_);
  p->difference_step = 1e-3;  // through contacts and frictions, as in diagnose
  for (std::size_t l = 0; l < sigma_.size(); ++l)
    for (std::size_t c = 0; c < sigma_[l].size(); ++c)
      p->set_sigma(static_cast<int>(l), static_cast<int>(c), sigma_[l][c]);
  made_.push_back(p);
  return p;
}

SubjectFit ValveSubject::fit(const std::vector<int>& causes, bool wide) const {
  const std::shared_ptr<FitProblem> p = problem(causes, wide);
  SubjectFit out;
  for (std::size_t j = 0; j < base_count(wide); ++j) {
    const FreeValue& f = free_[j];
    const int at = f.at < n_parameters ? f.at : -1;
    out.numbers.push_back({f.name, at >= 0 ? std::string(parameter_list[static_cast<std::size_t>(at)].unit) : "",
                           f.lower, f.upper, f.log_scale, f.start, true, ""});
  }
  for (int c : causes)
    for (const Number& n : causes_[static_cast<std::size_t>(c)].numbers) out.numbers.push_back(n);
  out.start = p->start();
  out.problem.n = p->n();
  out.problem.evaluate = [this, p](std::span<const Point> points) {
    std::vector<Evaluation> e = p->evaluate(points);
    for (Evaluation& one : e)
      if (one.ok) remember(one.residual);
    return e;
  };
  out.problem.jacobian = [this, p](const Point& x, const Eigen::VectorXd& r, Eigen::MatrixXd& j) {
    Eigen::VectorXd plain = r;
    forget(plain);
    if (!p->jacobian(x, plain, j)) return false;
    for (long c = 0; c < j.cols(); ++c) remember(j.col(c));
    return true;
  };
  tie(out, causes_, causes);
  return out;
}

// A row that nothing is known before has the variance of the whole series, not of its news.
void ValveSubject::remember(Eigen::Ref<Eigen::VectorXd> rows) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const double alone = std::sqrt(1 - memory_[i] * memory_[i]);
    for (long k = series_[i].count - 1, at = series_[i].first + k; k >= 0; --k, --at)
      if (afresh_[i][static_cast<std::size_t>(k)])
        rows[at] *= alone;
      else
        rows[at] -= memory_[i] * rows[at - 1];
  }
}
void ValveSubject::forget(Eigen::Ref<Eigen::VectorXd> rows) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const double alone = std::sqrt(1 - memory_[i] * memory_[i]);
    for (long k = 0, at = series_[i].first; k < series_[i].count; ++k, ++at)
      if (afresh_[i][static_cast<std::size_t>(k)])
        rows[at] /= alone;
      else
        rows[at] += memory_[i] * rows[at - 1];
  }
}

Eigen::VectorXd ValveSubject::physical(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd plain = rows;
  forget(plain);
  return Subject::physical(plain);
}

Eigen::VectorXd ValveSubject::in_tuned_errors(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd r = physical(rows);
  for (std::size_t i = 0; i < series_.size(); ++i)
    for (long k = 0; k < series_[i].count; ++k) r[series_[i].first + k] /= tuned_sigma_[i][static_cast<std::size_t>(k)];
  return r;
}

std::vector<UsualError> ValveSubject::errors(const Eigen::VectorXd& rows) const {
  const Eigen::VectorXd r = in_tuned_errors(rows);
  std::vector<UsualError> out;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const Series& s = series_[i];
    double square = 0, neighbours = 0;
    for (long k = 0, at = s.first; k < s.count; ++k, ++at) {
      square += r[at] * r[at];
      if (!afresh_[i][static_cast<std::size_t>(k)]) neighbours += r[at] * r[at - 1];
    }
    out.push_back({s.signal, std::sqrt(square / static_cast<double>(s.count)),
                   square > 0 ? std::clamp(neighbours / square, 0.0, longest_memory) : 0.0, s.effective,
                   rate_of(*s.time)});
  }
  return out;
}

std::vector<Miss> ValveSubject::misses(const Eigen::VectorXd& rows) const {
  std::vector<Miss> out;
  std::vector<double> samples;
  const std::vector<UsualError> all = errors(rows);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const bool news : {false, true}) {
      const std::string part = all[i].signal + (news ? ", news" : "");
      std::size_t at = 0;
      while (at < out.size() && out[at].part != part) ++at;
      if (at == out.size()) out.push_back({part, 0}), samples.push_back(0);
      const auto n = static_cast<double>(series_[i].count);
      out[at].size += n * all[i].size * all[i].size * (news ? 1 - all[i].memory * all[i].memory : 1);
      samples[at] += n;
    }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].size = std::sqrt(out[i].size / samples[i]);
  return out;
}

double ValveSubject::own(int log, int at, const Point& point) const {
  const bool stated = at == nuisance::command_slope && logs_[static_cast<std::size_t>(log)].scenario.command_slope;
  return stated ? std::nan("") : problem({})->candidate(point, log)[static_cast<std::size_t>(at)];
}

double ValveSubject::thickness() const {
  double sum = 0;
  for (const LogData& l : logs_) {
    if (!l.scenario.oil_known) return std::nan("");
    sum += std::log(l.scenario.oil.viscosity_ratio);
  }
  return sum / static_cast<double>(logs_.size());
}

double ValveSubject::adequacy(const Eigen::VectorXd& rows) const {
  double sum = 0;
  double channels = 0;
  for (const Miss& m : misses(rows))
    if (!m.part.ends_with(", news")) sum += m.size * m.size, ++channels;
  return sum / std::max(1.0, channels);
}

// The channel's own size and memory; where healthy logs tell what is usual, their memory, and no larger size.
bool ValveSubject::rescale(const Eigen::VectorXd& rows) {
  Eigen::VectorXd white = in_tuned_errors(rows);
  const std::vector<UsualError> own = errors(rows);
  const auto news = [](const UsualError& e, double a) {
    return e.size * std::sqrt(std::max(0.0, 1 - 2 * a * e.memory + a * a));
  };
  std::vector<double> usual(series_.size(), 0.0), usual_effective(series_.size(), 0.0);  // 0: not known
  for (std::size_t i = 0; i < series_.size(); ++i) {
    memory_[i] = of_stand(static_cast<std::size_t>(series_[i].log)) ? 0.0 : own[i].memory;
    if (!known_) continue;
    std::vector<UsualError> same;
    std::vector<double> memories, sizes, fractions;
    for (UsualError e : known_->errors)
      if (e.signal == series_[i].signal) {
        e.memory = std::pow(e.memory, e.rate / own[i].rate);
        memories.push_back(e.memory), fractions.push_back(std::min(1.0, e.effective * e.rate / own[i].rate));
        same.push_back(e);
      }
    if (same.size() < 3) continue;
    memory_[i] = median(memories);
    for (const UsualError& e : same) sizes.push_back(news(e, memory_[i]));
    usual[i] = median(sizes), usual_effective[i] = median(fractions);
  }
  remember(white);
  std::size_t i = 0;
  for (auto& log : sigma_)
    for (auto& sigma : log) {
      Series& s = series_[i];
      const std::vector<double> said(white.data() + s.first, white.data() + s.first + s.count);
      double square = 0;
      for (double v : said) square += v * v;
      double size = std::sqrt(square / static_cast<double>(s.count));
      s.effective = effective_fraction(said);
      if (usual[i] > 0 && usual[i] < size) size = usual[i], s.effective = usual_effective[i];
      if (of_stand(static_cast<std::size_t>(s.log))) {
        const double points = travel_of(logs_[static_cast<std::size_t>(s.log)].scenario) / sweep_detail;
        s.effective = std::clamp(points / static_cast<double>(s.count), s.effective, 1.0);
      }
      for (std::size_t k = 0; k < sigma.size(); ++k)
        sigma[k] = std::max(tuned_sigma_[i][k] * size, s.noise) / std::sqrt(s.effective);
      ++i;
    }
  return true;
}

long ValveSubject::simulations() const {
  long n = 0;
  for (const auto& p : made_) n += p->simulations();
  return n;
}
long ValveSubject::failed_simulations() const {
  long n = 0;
  for (const auto& p : made_) n += p->failed_simulations();
  return n;
}

}  // namespace servodx
