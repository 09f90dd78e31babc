#include "explain/verdict.h"

#include "explain/constants.h"

namespace servodx {

using namespace explain_constants;

bool has_no_name(const EndEvidence& e) {
  const bool abnormal = e.compared && e.chance_left <= both_questions * e.level;
  return abnormal && (e.causes == 0 || e.share_of_first < most_of_it);
}

bool misses_without_name(const EndEvidence& e) {
  return !e.compared && e.causes == 0 && e.over_noise > arrived && e.block_misses > much_of_block;
}

ExplainVerdict verdict_of(const EndEvidence& e) {
  if (e.curve || misses_without_name(e) || (!e.told_by_blocks && has_no_name(e))) return ExplainVerdict::unexplained;
  return e.causes > 0 || e.told_of_drive ? ExplainVerdict::extended : ExplainVerdict::sufficient;
}

}  // namespace servodx
