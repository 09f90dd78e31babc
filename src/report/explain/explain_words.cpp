#include "report/explain/explain_words.h"

#include <fmt/format.h>

#include "explain/constants.h"

namespace servodx::report {

const char* word_of(ExplainVerdict verdict) {
  switch (verdict) {
    case ExplainVerdict::sufficient:
      return "sufficient";
    case ExplainVerdict::extended:
      return "extended";
    case ExplainVerdict::unexplained:
      return "unexplained";
  }
  return "";
}

const char* stamp_of(ExplainVerdict verdict) {
  switch (verdict) {
    case ExplainVerdict::sufficient:
      return "NOTHING NEW";
    case ExplainVerdict::extended:
      return "FOUND";
    case ExplainVerdict::unexplained:
      return "UNEXPLAINED";
  }
  return "";
}

const char* word_of(ToldBy told_by) {
  switch (told_by) {
    case ToldBy::simulation:
      return "simulation";
    case ToldBy::blocks:
      return "blocks";
    case ToldBy::currents:
      return "currents";
  }
  return "";
}

const char* words_of_share(ToldBy told_by) {
  switch (told_by) {
    case ToldBy::simulation:
      return "";
    case ToldBy::blocks:
      return ", of the blocks' error in the block replay";
    case ToldBy::currents:
      return ", of the error between the command and the coil current; the measured current drives the simulation";
  }
  return "";
}

const char* words_of(Fate fate) {
  switch (fate) {
    case Fate::not_looked_at:
      return "";
    case Fate::score_too_small:
      return "its predicted gain is too small";
    case Fate::not_worth_its_numbers:
      return "its gain is not worth its added parameters";
    case Fate::others_fit_better:
      return "others fit better";
    case Fate::abnormal_with_it:
      return "no larger than on healthy logs, and the data stay abnormal with it";
    case Fate::retuning_does_as_well:
      return "re-tuning alone does as well on held-out data";
    case Fate::no_heldout_gain:
      return "no gain on held-out data beyond its interval";
    case Fate::removes_too_little:
      return "removes too little to be an answer";
    case Fate::not_beyond_healthy:
      return "not beyond what healthy logs show";
    case Fate::not_missed_later:
      return "not needed once the other causes were in";
    case Fate::curve_does_better:
      return "a learnt curve does better";
    case Fate::blocks_tell_another:
      return "the block replay finds another cause";
    case Fate::taken:
      return "taken";
    case Fate::taken_by_blocks:
      return "taken: the block replay finds it";
  }
  return "";
}

std::string words_of(const ExcessPlace& place) {
  const auto sits = [&](const std::string& where) {
    return fmt::format("{:.0f} % of the excess sits {} ({:.0f} % of the time)", 100 * place.share, where,
                       100 * place.time);
  };
  constexpr double near = 1e3 * explain_constants::shown::near_event;  // [ms]
  switch (place.kind) {
    case ExcessPlace::Kind::none:
      return "nothing beyond the sensor's noise";
    case ExcessPlace::Kind::spread:
      return "the excess is spread evenly";
    case ExcessPlace::Kind::near_reversal:
      return sits(fmt::format("within {:.0f} ms of a reversal", near));
    case ExcessPlace::Kind::near_jump:
      return sits(fmt::format("within {:.0f} ms of a jump of the command", near));
    case ExcessPlace::Kind::lowest_part:
      return sits("in the lowest eighth of " + place.variable);
    case ExcessPlace::Kind::highest_part:
      return sits("in the highest eighth of " + place.variable);
  }
  return "";
}

const char* word_of(SizeTold told) {
  switch (told) {
    case SizeTold::interval:
      return "interval";
    case SizeTold::at_bound:
      return "at_bound";
    case SizeTold::not_told:
      return "not_told";
  }
  return "";
}

const char* words_of(SizeTold told) {
  switch (told) {
    case SizeTold::interval:
      return "";
    case SizeTold::at_bound:
      return "at a bound";
    case SizeTold::not_told:
      return "not determined by these logs";
  }
  return "";
}

}  // namespace servodx::report
