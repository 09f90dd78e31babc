// `servodx list KIND`: what there is, from the registries that own it.
#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/nearest.h"
#include "base/trouble.h"
#include "commands.h"
#include "invocation.h"
#include "report/list/schema.h"
#include "report/list/trouble_words.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "rig/excitations.h"
#include "servodx/data_sheet.h"
#include "servodx/instruction_set.h"
#include "servodx/lists.h"
#include "servodx/rig.h"
#include "servodx/table.h"

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
  for (const ListedFault& fault : listed_faults()) {
    table.row({fault.name, fault.unit, fault.meaning});
    out.items.push_back({{"name", fault.name},
                         {"unit", fault.unit},
                         {"meaning", fault.meaning},
                         {"healthy", fault.healthy},
                         {"least", fault.least},
                         {"worst", fault.worst},
                         {"separating_test", fault.separating_test},
                         {"action", fault.action}});
  }
  out.text = table.text();
  return out;
}

Json parameter_json(const ListedEffect::Parameter& p) {
  Json out = Json::object();
  if (p.id > 0) out["id"] = p.id;
  out["name"] = p.name, out["unit"] = p.unit, out["off"] = p.off;
  if (p.lower) out["lower"] = *p.lower, out["upper"] = p.upper.value(), out["start"] = p.start.value();
  out["meaning"] = p.meaning;
  return out;
}

Listing effects(const Options&, Invocation&) {
  Listing out;
  Columns table("lllll");
  table.row({"effect", "kind", "where", "frees the rows", "meaning"});
  for (const ListedEffect& effect : listed_effects()) {
    const char* kind = effect.of_table ? "table" : "file";
    std::vector<std::string> names;
    Json parameters = Json::array();
    for (const ListedEffect::Parameter& p : effect.parameters) {
      names.push_back(p.name);
      parameters.push_back(parameter_json(p));
    }
    table.row({effect.name, kind, effect.where, report::join(names), effect.meaning});
    out.items.push_back({{"name", effect.name},
                         {"kind", kind},
                         {"where", effect.where},
                         {"meaning", effect.meaning},
                         {"parameters", parameters}});
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
    for (const ListedRow& p : listed_rows()) {
      table.row({std::to_string(p.id), p.name, p.group, p.unit, p.meaning});
      out.items.push_back(
          {{"id", p.id}, {"name", p.name}, {"group", p.group}, {"unit", p.unit}, {"meaning", p.meaning}});
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
  Columns table("lrrll");
  table.row({"model", "states", "rows", "kernel", "meaning"});
  const ListedModel model = identification_model();
  table.row({model.name, std::to_string(model.states), std::to_string(model.rows), instruction_set(), model.meaning});
  out.items.push_back({{"name", model.name},
                       {"states", model.states},
                       {"rows", model.rows},
                       {"kernel", instruction_set()},
                       {"meaning", model.meaning}});
  for (const ListedMap& map : listed_maps()) {
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
  for (const ListedSignal& signal : listed_signals()) {
    table.row({signal.name, signal.si_unit, signal.accepted_units, signal.meaning});
    out.items.push_back({{"name", signal.name},
                         {"si_unit", signal.si_unit},
                         {"accepted_units", signal.accepted_units},
                         {"simulated", signal.simulated},
                         {"meaning", signal.meaning}});
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
  for (int i = 0; i < n_troubles; ++i) {
    const auto trouble = static_cast<Trouble>(i);
    const char* kind = report::is_refusal(trouble) ? "refusal" : "warning";
    out.items.push_back({{"code", code_of(trouble)},
                         {"kind", kind},
                         {"meaning", report::meaning_of(trouble)},
                         {"remedy", report::remedy_of(trouble)}});
  }
  out.text = report::table_of_troubles();
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
