// `servodx list KIND`: what there is, from the registries that own it.
#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/nearest.h"
#include "base/trouble.h"
#include "commands.h"
#include "effects/effect.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/nominal.h"
#include "invocation.h"
#include "model/state.h"
#include "parameters/list.h"
#include "report/list/schema.h"
#include "report/list/trouble_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "rig/excitations.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "signals/signal.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "valve_maps/registry.h"

namespace servodx {
namespace {

using report::Columns;
using report::Json;

struct Options {
  CommonOptions common;
  std::string kind, params;
};

struct Listing {
  std::string text;
  Json items = Json::array();
};

Listing faults(const Options&, Invocation&) {
  Listing out;
  Columns table("lll");
  table.row({"fault", "severity", "meaning"});
  for (const Fault* fault : fault_list()) {
    table.row({std::string(fault->name), std::string(fault->unit), std::string(fault->meaning)});
    out.items.push_back({{"name", fault->name},
                         {"unit", fault->unit},
                         {"meaning", fault->meaning},
                         {"healthy", fault->healthy},
                         {"least", fault->least},
                         {"worst", fault->worst},
                         {"separating_test", fault->test},
                         {"action", fault->action}});
  }
  out.text = table.text();
  return out;
}

Listing effects(const Options&, Invocation&) {
  Listing out;
  Columns table("lllll");
  table.row({"effect", "kind", "where", "frees the rows", "meaning"});
  const auto add = [&](const std::string& name, const char* kind, const std::string& where, const std::string& meaning,
                       const Json& parameters) {
    std::vector<std::string> names;
    for (const Json& p : parameters) names.push_back(p.at("name"));
    table.row({name, kind, where, report::join(names), meaning});
    out.items.push_back(
        {{"name", name}, {"kind", kind}, {"where", where}, {"meaning", meaning}, {"parameters", parameters}});
  };
  for (const EffectInfo& effect : effect_list()) {
    Json parameters = Json::array();
    for (const EffectParameter& p : effect.parameters)
      parameters.push_back({{"name", p.name},
                            {"unit", p.unit},
                            {"off", p.off},
                            {"lower", p.lower},
                            {"upper", p.upper},
                            {"start", p.start},
                            {"meaning", p.meaning}});
    add(effect.name, "file", effect.place, effect.meaning, parameters);
  }
  for (const RowEffect& effect : row_effects()) {
    Json parameters = Json::array();
    for (const int at : effect.rows) {
      const ParameterInfo& p = parameter_list[static_cast<std::size_t>(at)];
      parameters.push_back(
          {{"id", p.id}, {"name", p.name}, {"unit", p.unit}, {"off", effect.off}, {"meaning", p.meaning}});
    }
    for (const int at : effect.shapes) {
      const EffectParameter& p = parameter_at(at);
      parameters.push_back({{"name", p.name}, {"unit", p.unit}, {"off", p.off}, {"meaning", p.meaning}});
    }
    add(effect.name, "table", effect.where, effect.meaning, parameters);
  }
  out.text =
      table.text() +
      "file: physics of its own, src/effects/; 'tune --effects A,B' adds its rows and frees them\n"
      "table: rows among the 41; 'estimate' 1 frees one, 0 holds it at its nominal value; air is fitted log by log\n";
  return out;
}

// The rows of a table with the rig's facts, each with the source of its value; without a table, what the rows mean.
Listing params(const Options& options, Invocation& invocation) {
  require_option(!options.params.empty() || options.common.rig.empty(), "--rig", "the facts need a table to apply to",
                 "add --params P");
  Listing out;
  if (options.params.empty()) {
    Columns table("rllll");
    table.row({"id", "name", "group", "unit", "meaning"});
    for (const ParameterInfo& p : parameter_list) {
      table.row({std::to_string(p.id), std::string(p.name), std::string(name_of(p.group)), std::string(p.unit),
                 std::string(p.meaning)});
      out.items.push_back(
          {{"id", p.id}, {"name", p.name}, {"group", name_of(p.group)}, {"unit", p.unit}, {"meaning", p.meaning}});
    }
    out.text = table.text();
    return out;
  }
  const RigFile rig = invocation.rig();
  const Table rows = apply_rig_facts(invocation.table(options.params), rig);
  if (rows.has_std_error && !rig.path.empty())
    invocation.header().notes.push_back(options.params + " is tuned: its values stand, the facts are not applied");
  Columns table("rlrrrlll");
  table.row({"id", "name", "nominal", "lower", "upper", "unit", "free", "source"});
  for (const Row& row : rows.rows) {
    table.row({row.id > 0 ? std::to_string(row.id) : "", row.name, report::digits(row.nominal, 5),
               report::digits(row.lower, 4), report::digits(row.upper, 4), row.unit, row.estimate ? "yes" : "no",
               row.source});
    out.items.push_back({{"id", row.id > 0 ? Json(row.id) : Json(nullptr)},
                         {"name", row.name},
                         {"group", row.group},
                         {"nominal", row.nominal},
                         {"lower", row.lower},
                         {"upper", row.upper},
                         {"scale", row.log_scale ? "log10" : "lin"},
                         {"estimate", row.estimate},
                         {"unit", row.unit},
                         {"std_error", row.std_error ? Json(*row.std_error) : Json(nullptr)},
                         {"source", row.source}});
  }
  out.text = table.text();
  return out;
}

Listing models(const Options&, Invocation&) {
  Listing out;
  constexpr const char* meaning =
      "two-stage flapper-nozzle valve with feedback wire, lines and actuator; what logs are fitted with";
  Columns table("lrrll");
  table.row({"model", "states", "rows", "kernel", "meaning"});
  table.row(
      {"identification", std::to_string(n_base_states), std::to_string(n_parameters), instruction_set(), meaning});
  out.items.push_back({{"name", "identification"},
                       {"states", n_base_states},
                       {"rows", n_parameters},
                       {"kernel", instruction_set()},
                       {"meaning", meaning}});
  for (const valve_maps::MapInfo& map : valve_maps::map_list()) {
    table.row({map.name, "0", "", "", "valve map: " + map.meaning});
    out.items.push_back({{"name", map.name}, {"kind", "valve map"}, {"meaning", map.meaning}});
  }
  out.text = table.text() + "valve map: load pressure from spool position and load flow; 'servodx map --model NAME'\n";
  return out;
}

Listing signals(const Options&, Invocation&) {
  Listing out;
  Columns table("llll");
  table.row({"signal", "inside", "accepted units", "meaning"});
  for (const SignalInfo& signal : signal_list) {
    table.row({std::string(signal.name), std::string(signal.si_unit), accepted_units(signal.signal),
               std::string(signal.description)});
    out.items.push_back({{"name", signal.name},
                         {"si_unit", signal.si_unit},
                         {"accepted_units", accepted_units(signal.signal)},
                         {"simulated", simulated_index(signal.signal) >= 0},
                         {"meaning", signal.description}});
  }
  out.text = table.text();
  return out;
}

Listing excitations(const Options&, Invocation&) {
  Listing out;
  Columns table("ll");
  table.row({"excitation", "meaning"});
  for (const rig::ExcitationInfo& excitation : rig::excitations()) {
    table.row({excitation.name, excitation.description});
    out.items.push_back({{"name", excitation.name}, {"meaning", excitation.description}});
  }
  out.text = table.text();
  return out;
}

Listing errors(const Options&, Invocation&) {
  Listing out;
  Columns table("llll");
  table.row({"code", "kind", "meaning", "what to do"});
  for (int i = 0; i < n_troubles; ++i) {
    const auto trouble = static_cast<Trouble>(i);
    const char* kind = report::is_refusal(trouble) ? "refusal" : "warning";
    table.row({code_of(trouble), kind, report::meaning_of(trouble), report::remedy_of(trouble)});
    out.items.push_back({{"code", code_of(trouble)},
                         {"kind", kind},
                         {"meaning", report::meaning_of(trouble)},
                         {"remedy", report::remedy_of(trouble)}});
  }
  out.text = table.text();
  return out;
}

Listing fields(const Options&, Invocation&) {
  Listing out;
  Columns table("lllll");
  table.row({"file", "field", "type", "unit", "meaning"});
  for (const report::FieldGroup& group : report::field_groups())
    for (const report::Field& f : group.fields) {
      table.row({group.name, f.name, f.type, f.unit, f.meaning});
      out.items.push_back({{"file", group.name},
                           {"kind", report::kind_of(group)},
                           {"field", f.name},
                           {"type", f.type},
                           {"unit", f.unit},
                           {"meaning", f.meaning},
                           {"may_be_missing", f.may_be_missing}});
    }
  out.text = table.text();
  return out;
}

Listing schemas(const Options&, Invocation&) {
  Listing out;
  Columns table("ll");
  table.row({"file", "meaning"});
  for (const report::FieldGroup& group : report::field_groups()) {
    if (!report::is_whole_file(group)) continue;
    table.row({group.name, group.meaning});
    out.items.push_back({{"name", group.name}, {"meaning", group.meaning}, {"schema", report::schema_of(group)}});
  }
  out.text = table.text() + "with --json: the JSON Schema of each\n";
  return out;
}

struct Kind {
  const char* name;
  Listing (*make)(const Options&, Invocation&);
};
constexpr std::array<Kind, 9> kinds = {{{"faults", faults},
                                        {"effects", effects},
                                        {"params", params},
                                        {"models", models},
                                        {"signals", signals},
                                        {"excitations", excitations},
                                        {"errors", errors},
                                        {"fields", fields},
                                        {"schemas", schemas}}};

void run(const Options& options) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) {
    names.emplace_back(kind.name);
    if (options.kind != kind.name) continue;
    Invocation invocation("list", options.common);
    invocation.check_files({options.params}, {});
    *invocation.header().settings = {{"kind", options.kind}};
    const Listing listing = kind.make(options, invocation);
    if (invocation.dry_run()) return;
    invocation.finish(listing.text, {{options.kind, listing.items}});
    return;
  }
  throw InputError({}, "there is no list of '" + options.kind + "'",
                   did_you_mean(options.kind, names) + "use one of " + report::join(names));
}

}  // namespace

void add_list_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "list", "What there is: faults, effects, params, models, signals, excitations, errors, fields, schemas");
  command
      ->add_option("KIND", options->kind,
                   "faults, effects, params, models, signals, excitations, errors, fields or schemas")
      ->required();
  command->add_option("--params", options->params, "with 'params': the values of this table and where they come from")
      ->type_name("P");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
