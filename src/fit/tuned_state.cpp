#include "fit/tuned_state.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "base/error.h"
#include "base/sha256.h"
#include "base/toml_text.h"
#include "fit/tuning_comments.h"
#include "servodx/log.h"
#include "servodx/table.h"
#include "signals/fingerprint.h"

namespace servodx {
namespace {

double number_after(const std::string& line, const std::string& key) {
  const std::size_t at = line.find(key);
  return at == std::string::npos ? std::nan("") : std::strtod(line.c_str() + at + key.size(), nullptr);
}

// "model error spool_position: floor 1e-6 m, per activity 0.1, independent 20 1/s"
std::optional<ChannelError> old_channel(const std::string& line) {
  const std::size_t name = std::string_view(error_key).size() + 1, colon = line.find(':');
  const auto signal = find_signal(line.substr(name, colon - name));
  if (!signal) return {};
  const ChannelError c{*signal, number_after(line, "floor "), number_after(line, "per activity "),
                       number_after(line, "independent ")};
  const bool holds = std::isfinite(c.floor) && std::isfinite(c.per_activity) && c.independent > 0;
  return holds ? std::optional(c) : std::nullopt;
}

void put(ErrorModel& model, const ChannelError& channel) {
  const auto same = std::find_if(model.channels.begin(), model.channels.end(),
                                 [&](const ChannelError& c) { return c.signal == channel.signal; });
  if (same == model.channels.end())
    model.channels.push_back(channel);
  else
    *same = channel;
}

TunedState of_comments(const std::vector<std::string>& comments) {
  TunedState state;
  for (const std::string& line : newest_tuning(comments)) {
    if (line.starts_with(error_key)) {
      if (const auto channel = old_channel(line)) put(state.error, *channel);
    } else if (line.starts_with(average_key)) {
      state.recorder.moving_average = std::max(1, std::atoi(line.c_str() + std::string_view(average_key).size() + 1));
    } else {
      std::istringstream words(line.substr(std::string_view(tuned_by_key).size()));
      TunedBy by;
      words >> by.sha256 >> by.log;
      state.by.push_back(by);
    }
  }
  return state;
}

[[noreturn]] void refuse(const Table& table, const std::string& rule) {
  throw InputError({.file = table.path}, rule, "make the table again with 'servodx tune'");
}

TunedState of_section(const Table& table) {
  toml::table section;
  try {
    section = parse_toml(table.state, table.path, "");
  } catch (const InputError& error) {
    refuse(table, fmt::format("its lines '#%' cannot be read, the {}. of them {}", error.where.line, error.rule));
  }
  const auto tuned = section["tuned"];
  const int schema = tuned["schema"].value_or(0);
  if (schema < 1 || schema > TunedState::schema)
    refuse(table,
           fmt::format("its lines '#%' are of schema {}, this program reads up to {}", schema, TunedState::schema));
  TunedState state;
  state.recorder.moving_average = tuned["moving_average"].value_or(1);
  if (const toml::table* slope = tuned["command_slope"].as_table()) {
    const CommandSlope s{(*slope)["usual"].value_or(std::nan("")), (*slope)["spread"].value_or(std::nan(""))};
    if (!(s.usual >= 0 && s.usual <= 1) || !(s.spread > 0))
      refuse(table, "its lines '#%' hold no slope of the command between samples");
    state.recorder.command_slope = s;
  }
  const auto text = [](const toml::table& from, std::string_view key) { return from[key].value_or(std::string()); };
  if (const toml::array* channels = tuned["error"].as_array())
    for (const toml::node& node : *channels) {
      const toml::table* channel = node.as_table();
      const auto signal = channel ? find_signal(text(*channel, "signal")) : std::nullopt;
      if (!signal) refuse(table, "its lines '#%' name an unknown signal");
      const auto number = [&](std::string_view key) { return (*channel)[key].value_or(std::nan("")); };
      const ChannelError c{*signal, number("floor"), number("per_activity"), number("independent")};
      if (!std::isfinite(c.floor) || !std::isfinite(c.per_activity) || !(c.independent > 0))
        refuse(table, fmt::format("its lines '#%' hold no error of '{}'", name_of(*signal)));
      put(state.error, c);
    }
  if (const toml::array* channels = tuned["unfollowed"].as_array())
    for (const toml::node& node : *channels) {
      const toml::table* channel = node.as_table();
      const auto signal = channel ? find_signal(text(*channel, "signal")) : std::nullopt;
      const double over_noise = channel ? (*channel)["over_noise"].value_or(std::nan("")) : std::nan("");
      if (!signal || !std::isfinite(over_noise)) refuse(table, "its lines '#%' name an unknown signal");
      state.unfollowed.push_back({*signal, over_noise});
    }
  if (const toml::array* logs = tuned["by"].as_array())
    for (const toml::node& node : *logs)
      if (const toml::table* log = node.as_table())
        state.by.push_back({text(*log, "log"), text(*log, "sha256"), text(*log, "content")});
  return state;
}

}  // namespace

std::vector<TunedBy> tuned_by(const Table& table) { return tuned_state(table).by; }

bool TunedState::is_by(const Log& log) const {
  const bool any_content = std::any_of(by.begin(), by.end(), [](const TunedBy& b) { return !b.content.empty(); });
  const std::string content = any_content ? content_hash(log) : "";
  return std::any_of(by.begin(), by.end(), [&](const TunedBy& b) {
    return is_same_log({b.sha256, b.content}, {log.sha256, content});
  });
}

TunedState tuned_state(const Table& table) {
  return table.state.empty() ? of_comments(table.comments) : of_section(table);
}

ErrorModel required_error_model(const Table& tuned) {
  ErrorModel error = error_model_of(tuned);
  if (error.channels.empty())
    throw InputError({.file = tuned.path}, "the table does not say how wrong its model is",
                     "make it with 'servodx tune'; the file then carries lines '#% ...' ahead of its header");
  return error;
}

void set_tuned_state(Table& table, const TunedState& state) {
  table.comments = without_tunings(table.comments);
  std::string& out = table.state;
  out = fmt::format("[tuned]\nschema = {}\nmoving_average = {}\n", TunedState::schema, state.recorder.moving_average);
  if (const auto& slope = state.recorder.command_slope)
    out += fmt::format(
        "[tuned.command_slope]  # of the command between samples: 0 held, 1 in a line\n"
        "usual = {}\nspread = {}  # standard deviation of one more log's\n",
        slope->usual, slope->spread);
  for (const ChannelError& c : state.error.channels)
    out += fmt::format(
        "[[tuned.error]]  # sigma^2 = noise^2 + floor^2 + (per_activity * movement in 1 ms)^2\n"
        "signal = \"{}\"\nfloor = {}  # [{}]\nper_activity = {}\nindependent = {}  # samples a second\n",
        name_of(c.signal), c.floor, info(c.signal).si_unit, c.per_activity, c.independent);
  for (const Unfollowed& u : state.unfollowed)
    out += fmt::format("[[tuned.unfollowed]]\nsignal = \"{}\"\nover_noise = {}\n", name_of(u.signal), u.over_noise);
  const auto quoted = [](const std::string& text) {
    std::ostringstream s;
    s << toml::value<std::string>(text);
    return s.str();
  };
  for (const TunedBy& b : state.by)
    out +=
        fmt::format("[[tuned.by]]\nlog = {}\nsha256 = \"{}\"\ncontent = \"{}\"\n", quoted(b.log), b.sha256, b.content);
}

// What the bits of a result follow from: rows as they are read, and the state's values. Files' names are left out.
std::string content_hash(const Table& table) {
  std::string text;
  for (const Row& row : table.rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},", row.name, row.group, row.unit, row.log_scale ? "log10" : "lin",
                        row.estimate ? 1 : 0, row.nominal, row.lower, row.upper);
    if (row.std_error) text += fmt::format("{}", *row.std_error);
    text += '\n';
  }
  const TunedState state = tuned_state(table);
  text += fmt::format("moving average {}\n", state.recorder.moving_average);
  if (const auto& slope = state.recorder.command_slope)
    text += fmt::format("command slope {} {}\n", slope->usual, slope->spread);
  for (const ChannelError& c : state.error.channels)
    text += fmt::format("error {} {} {} {}\n", name_of(c.signal), c.floor, c.per_activity, c.independent);
  for (const Unfollowed& u : state.unfollowed)
    text += fmt::format("unfollowed {} {}\n", name_of(u.signal), u.over_noise);
  for (const TunedBy& b : state.by) text += fmt::format("by {} {}\n", b.sha256, b.content);
  return sha256(text);
}

bool has_old_state(const Table& table) { return table.state.empty() && !newest_tuning(table.comments).empty(); }

}  // namespace servodx
