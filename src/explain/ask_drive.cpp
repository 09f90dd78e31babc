#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/median.h"
#include "explain/answer.h"
#include "explain/describe.h"
#include "explain/drive.h"
#include "explain/engine.h"
#include "explain/healthy.h"
#include "explain/inquiry.h"

namespace servodx {
namespace {

// What healthy logs show of the cause, by the size each was nearest to; none: no log speaks of it. [its unit]
double usual_value(const Inquiry& q, const Cause& cause) {
  std::vector<double> values;
  const Number& n = cause.numbers.front();
  for (const HealthyLog& log : q.speaking().logs)
    for (const HealthyScore& s : log.scores) {
      if (s.effect != cause.effect || s.where != place_key(cause)) continue;
      double value = n.off, nearest = 1e300;
      for (std::size_t a = 0; a < s.sizes.size() && a < cause.probes.size(); ++a)
        if (const double off = std::abs(s.sizes[a].size - 1); off < nearest)
          nearest = off, value = n.off + s.sizes[a].size * (cause.probes[a].front().front() - n.off);
      values.push_back(value);
    }
  return values.empty() ? n.off : median(values);
}

}  // namespace

void ask_drive(Inquiry& q, Answer& answer) {
  if (!q.test() || !answer.found.before.ok) return;
  auto drive = std::make_unique<DriveSubject>(q.logs());
  if (drive->empty()) return;
  const SizesByLog none;
  EngineOptions engine;
  engine.seed = q.options().seed, engine.stop = q.options().watch.stop, engine.level = q.level();
  engine.among = [&](const Cause& c) { return q.has_name(c); };
  engine.p_new = chance_of_size(*q.test(), *drive, none);
  FoundCauses told = explain(*drive, engine);
  if (!told.before.ok) return;
  answer.drive = std::move(drive);
  answer.of_drive = std::move(told);
}

ExplainedCause described_of_drive(const Inquiry& q, const Answer& answer, const CauseResult& r) {
  const Cause& c = answer.drive->causes()[static_cast<std::size_t>(r.cause)];
  ExplainedCause out;
  out.effect = c.effect, out.where = c.where, out.test = c.test, out.meaning = meaning_of(c);
  out.heldout_gain = r.heldout_gain, out.beyond_retuning = r.beyond_retuning, out.delta_bic = r.delta_bic;
  out.told_by = ToldBy::currents;
  const Number& n = c.numbers.front();
  const double error = std::hypot(r.std_error[0], healthy_spread(*answer.drive, *q.test(), r.cause, 0, r.std_error[0]));
  out.parameters.push_back({n.name, n.unit, r.value[0], error, usual_value(q, c)});
  for (const int other : r.confusable_with)
    out.confusable_with.push_back(answer.drive->causes()[static_cast<std::size_t>(other)].effect);
  return out;
}

}  // namespace servodx
