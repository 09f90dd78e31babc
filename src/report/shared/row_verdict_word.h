// The word for what logs say of a row, as results write it.
#pragma once
#include <string>

#include "fit/identifiability.h"
#include "servodx/table.h"

namespace servodx::report {

inline std::string word_of(RowVerdict verdict) {
  switch (verdict) {
    case RowVerdict::bounded:
      return "bounded";
    case RowVerdict::one_sided:
      return "one_sided";
    case RowVerdict::flat:
      return "flat";
    case RowVerdict::at_bound:
      return "at_bound";
    case RowVerdict::confounded:
      return "confounded";
    case RowVerdict::frozen:
      return "frozen";
  }
  return {};
}

}  // namespace servodx::report
