#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "explain/answer.h"
#include "explain/beside_healthy.h"
#include "explain/constants.h"
#include "explain/describe.h"
#include "explain/drive.h"
#include "explain/engine.h"
#include "explain/explain.h"
#include "explain/healthy.h"
#include "explain/inquiry.h"
#include "explain/outcome.h"
#include "explain/subject.h"
#include "explain/valve.h"

namespace servodx {

void ask_drive(Inquiry& q, Answer& answer) {
  if (!q.test() || !answer.found.before.ok) return;
  auto drive = std::make_unique<DriveSubject>(q.logs(), q.known().value_or(KnownRig{}));
  if (drive->empty()) return;
  // The driver has data and causes of its own, so what healthy logs scatter by in the valve's says nothing of them.
  const HealthyReference healthy = of_causes(q.speaking(), *drive);
  const HealthyTest test(healthy);
  const SizesByLog none;
  EngineOptions engine;
  engine.seed = q.options().seed, engine.stop = q.options().watch.stop;
  engine.level = explain_constants::drive::of_level * q.level();
  engine.among = [&](const Cause& c) { return q.has_name(c); };
  engine.p_new = chance_of_size(test, *drive, none);
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
  const double sample = answer.drive->sample_period();
  double error = std::hypot(r.std_error[0], healthy_spread(*answer.drive, *q.test(), r.cause, 0, r.std_error[0]));
  if (r.cause == DriveSubject::by_delay) error = std::hypot(error, answer.drive->time_error());
  out.parameters.push_back(sized(n, r.value[0], error));
  // A delay and a lag within one sample look alike.
  const bool within_sample = answer.drive->time_beyond_usual(r.cause, r.value[0]) < sample;
  for (int other = 0; other < static_cast<int>(answer.drive->causes().size()); ++other) {
    const bool as_good = std::count(r.confusable_with.begin(), r.confusable_with.end(), other) > 0;
    if (other != r.cause && (within_sample || as_good))
      out.confusable_with.push_back(answer.drive->causes()[static_cast<std::size_t>(other)].effect);
  }
  return out;
}

}  // namespace servodx
