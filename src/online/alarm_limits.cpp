#include "online/alarm_limits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "base/median.h"
#include "evidence/tail_law.h"
#include "fit/log_data.h"
#include "online/constants.h"
#include "online/residuals.h"
#include "signals/noise.h"
#include "signals/sample.h"
#include "signals/signal.h"

namespace servodx {
namespace {

namespace k = online_constants;

// Of one question, in one block of healthy data.
double chance_of(double alarms_per_hour, std::size_t channels) {
  return alarms_per_hour * k::block / 3600.0 / static_cast<double>(channels * k::n_windows);
}

using Blocks = std::map<Signal, std::array<std::vector<double>, k::n_windows>>;  // largest levels

// The levels of one healthy log, block by block.
double add_blocks(const Log& log, const WatchedModel& model, Blocks& blocks) {
  std::vector<Signal> recorded;
  for (const SignalInfo& s : signal_list)
    if (s.signal != Signal::time && log.has(s.signal)) recorded.push_back(s.signal);
  Residuals residuals(model, recorded);
  SlidingEvidence evidence(residuals.channels().size());
  const std::vector<Sample> samples = samples_of(log);
  std::vector<Levels> most(residuals.channels().size(), Levels{});
  double begun = log.time.front(), compared = 0;
  const auto close = [&] {
    for (std::size_t c = 0; c < most.size(); ++c)
      for (std::size_t w = 0; w < most[c].size(); ++w) {
        if (most[c][w] > 0) blocks[residuals.channels()[c]][w].push_back(most[c][w]);
        most[c][w] = 0;
      }
  };
  for (std::size_t from = 0; from < samples.size();) {
    std::size_t to = from;
    while (to < samples.size() && samples[to].time < samples[from].time + k::part) ++to;
    for (const Residual& r : residuals.take(std::span(samples).subspan(from, to - from))) {
      evidence.take(r);
      if (!r.comparable) continue;
      compared = r.time - log.time.front();
      for (std::size_t c = 0; c < most.size(); ++c)
        for (std::size_t w = 0; w < most[c].size(); ++w) most[c][w] = std::max(most[c][w], evidence.levels()[c][w]);
      if (r.time - begun >= k::block) close(), begun = r.time;
    }
    from = to;
  }
  close();
  return compared;
}

std::map<Signal, double> noise_in(const std::vector<Log>& logs) {
  std::map<Signal, std::vector<double>> each;
  for (const Log& log : logs)
    for (const SignalInfo& s : signal_list)
      if (s.signal != Signal::time && log.has(s.signal))
        each[s.signal].push_back(
            noise_of(log[s.signal], log.channels[static_cast<std::size_t>(index(s.signal))].resolution));
  std::map<Signal, double> out;
  for (auto& [signal, noise] : each) {
    std::sort(noise.begin(), noise.end());
    out[signal] = noise[noise.size() / 2];
  }
  return out;
}

std::optional<SupplyBand> supply_band(const std::vector<Log>& logs) {
  std::vector<double> levels, means;
  for (const Log& log : logs) {
    if (!log.has(Signal::supply_pressure)) continue;
    const std::vector<Sample> samples = samples_of(log);
    std::vector<double> present;
    for (const Sample& s : samples)
      if (const double p = s[Signal::supply_pressure]; !std::isnan(p)) present.push_back(p);
    levels.push_back(median(present));
    double asked = samples.front().time;
    std::size_t from = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      while (samples[from].time < samples[i].time - k::supply_window) ++from;
      if (samples[i].time < asked + k::part) continue;
      asked = samples[i].time;
      if (const double mean = recent_supply(std::span(samples).subspan(from, i + 1 - from)); !std::isnan(mean))
        means.push_back(mean);
    }
  }
  if (means.empty()) return {};
  SupplyBand out{.level = median(levels)};
  for (const double m : means) out.healthy = std::max(out.healthy, std::abs(m - out.level));
  out.limit = std::max(k::supply_strays * std::abs(out.level), k::supply_beyond_healthy * out.healthy);
  return out;
}

}  // namespace

double recent_supply(std::span<const Sample> samples) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (samples.empty()) return none;
  const double last = samples.back().time;
  double sum = 0, first = last;
  int n = 0;
  for (auto s = samples.rbegin(); s != samples.rend() && s->time >= last - k::supply_window; ++s) {
    const double p = (*s)[Signal::supply_pressure];
    if (!std::isnan(p)) sum += p, ++n, first = s->time;
  }
  return n >= 3 && last - first >= 0.9 * k::supply_window ? sum / n : none;
}

ChannelLimits usual_limits(double alarms_per_hour, std::size_t channels) {
  ChannelLimits out;
  const TailLaw law({}, {k::usual_level, k::usual_blocks});
  // So few blocks would ask for a limit beyond all reason: the levels that no log has shown are taken as known.
  const double known = -k::usual_level * std::log(chance_of(alarms_per_hour, channels));
  out.limit.fill(std::min(law.excess_at(chance_of(alarms_per_hour, channels)), known));
  return out;
}

WatchLimits learn_limits(const std::vector<Log>& healthy, WatchedModel model, double alarms_per_hour) {
  WatchLimits out;
  out.alarms_per_hour = alarms_per_hour;
  out.logs = static_cast<int>(healthy.size());
  out.noise = model.noise = noise_in(healthy);
  out.supply = supply_band(healthy);
  Blocks blocks;
  for (const Log& log : healthy) out.healthy_seconds += add_blocks(log, model, blocks);
  for (auto& [signal, of_windows] : blocks) {
    ChannelLimits& channel = out.channels[signal];
    for (std::size_t w = 0; w < of_windows.size(); ++w) {
      const double most = of_windows[w].empty() ? 0 : *std::max_element(of_windows[w].begin(), of_windows[w].end());
      const TailLaw law(of_windows[w], {k::usual_level, k::usual_blocks});
      channel.healthy[w] = most;
      channel.limit[w] = std::max(
          {k::least_limit, k::beyond_healthy * most, law.excess_at(chance_of(alarms_per_hour, blocks.size()))});
    }
  }
  return out;
}

}  // namespace servodx
