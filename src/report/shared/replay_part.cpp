#include "report/shared/replay_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/present.h"
#include "base/units.h"
#include "fit/log_data.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"
#include "servodx/log.h"
#include "servodx/replay.h"
#include "signals/signal.h"

namespace servodx::report {
namespace {

constexpr std::size_t numbers_of_a_page = 350000;  // drawn, all plots together; about 8 bytes each
constexpr std::size_t fewest_rows = 400, most_rows = 12000;

// A channel's own unit where it is absolute; else one that suits.
HandyUnit unit_of(const ReplayedChannel& channel) {
  const SignalInfo& signal = info(channel.signal);
  const Unit* unit = find_unit(channel.unit);
  if (unit && unit->dimension == signal.dimension) return {std::string(unit->name), 1.0 / unit->scale()};
  double greatest = 0;
  for (const double v : channel.measured)
    if (std::isfinite(v)) greatest = std::max(greatest, std::abs(v));
  return handy_unit(std::string(signal.si_unit), greatest);
}

std::vector<double> scaled(std::vector<double> v, double factor) {
  for (double& x : v) x *= factor;
  return v;
}

// How far the first explanation misses the channel, in sigmas.
double whitened_rms(const ReplayedChannel& channel) {
  if (channel.simulated.empty() || channel.sigma.empty()) return 0;
  std::vector<double> w = channel.simulated.front().residual;
  for (std::size_t k = 0; k < w.size(); ++k) w[k] /= channel.sigma[k];
  return rms_of_present(w);
}

Role role_of(std::size_t place) { return place == 0 ? Role::reference : place == 1 ? Role::named : Role::other; }

}  // namespace

std::string words(std::string label) {
  std::replace(label.begin(), label.end(), '_', ' ');
  // A port's letter: "pressure_a" -> "pressure A".
  if (const std::size_t n = label.size(); n > 2 && label[n - 2] == ' ')
    label[n - 1] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[n - 1])));
  return label;
}

std::string file_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

void add_replay(Page& page, const Replay& replay, const ReplayView& view) {
  std::size_t columns = 2;
  for (const ReplayedChannel& c : replay.channels) columns += 5 + 2 * std::min<std::size_t>(c.simulated.size(), 3);
  const std::size_t rows =
      std::clamp(numbers_of_a_page / (columns * std::max<std::size_t>(1, view.logs)), fewest_rows, most_rows);
  const auto plot = [&](std::string title, bool last) {
    Plot p;
    p.title = std::move(title);
    p.x = replay.time;
    p.x_label = "time [s]";
    p.x_label_shown = last;
    p.group = replay.log;
    p.most_rows = rows;
    if (view.onset) p.x_marks = {{*view.onset, "since"}};
    return p;
  };

  Plot input = plot(replay.current_measured ? "coil current [mA]" : "command [mA]", false);
  input.low = true;
  input.series.push_back({"command", scaled(replay.command, 1e3), Role::input});
  page.add(input);
  std::vector<const ReplayedChannel*> order;
  for (const ReplayedChannel& channel : replay.channels) order.push_back(&channel);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return whitened_rms(*a) > whitened_rms(*b); });
  for (const ReplayedChannel* next : order) {
    const ReplayedChannel& channel = *next;
    std::vector<const ReplayedChannel::Simulated*> shown;
    for (const auto& s : channel.simulated)
      if (view.shown.empty() || std::find(view.shown.begin(), view.shown.end(), s.name) != view.shown.end())
        shown.push_back(&s);
    if (!view.shown.empty())
      std::stable_sort(shown.begin(), shown.end(), [&](const auto* a, const auto* b) {
        const auto at = [&](const auto* s) { return std::find(view.shown.begin(), view.shown.end(), s->name); };
        return at(a) < at(b);
      });
    const HandyUnit unit = unit_of(channel);
    const std::string name = words(std::string(info(channel.signal).name));
    Plot trace = plot(fmt::format("{} [{}]", name, unit.name), false);
    trace.series.push_back({"measured", scaled(channel.measured, unit.factor), Role::measured});
    for (std::size_t i = 0; i < shown.size(); ++i)
      trace.series.push_back({words(shown[i]->name), scaled(shown[i]->value, unit.factor), role_of(i)});
    page.add(trace);

    double size = 0;
    for (const auto* s : shown) size = std::max(size, rms_of_present(s->residual));
    // In the trace's own unit where that reads well: who logs psi thinks in psi.
    const bool reads_well = size * unit.factor >= 0.1 && size * unit.factor < 1000;
    const HandyUnit small = reads_well ? unit : handy_unit(std::string(info(channel.signal).si_unit), size);
    std::string figures;
    for (const auto* s : shown)
      figures += fmt::format("{}{} {}", figures.empty() ? "" : ", ", words(s->name),
                             digits(rms_of_present(s->residual) * small.factor));
    const std::string filtered = channel.signal == Signal::piston_position
                                     ? fmt::format(", drift below {:g} Hz left out", piston_high_pass)
                                     : "";
    Plot residual = plot(fmt::format("{}: measured less simulated{} [{}]; rms {}", name, filtered, small.name, figures),
                         next == order.back());
    residual.low = true;
    for (std::size_t i = 0; i < shown.size(); ++i)
      residual.series.push_back({words(shown[i]->name), scaled(shown[i]->residual, small.factor), role_of(i)});
    if (!channel.sigma.empty())
      residual.band = Band{"within 2 sigma of fault-free", scaled(channel.sigma, -2 * small.factor),
                           scaled(channel.sigma, 2 * small.factor)};
    page.add(residual);
  }
}

}  // namespace servodx::report
