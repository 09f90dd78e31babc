// What the codes of refusals and warnings mean, in a line each; docs/errors.md says more.
#pragma once
#include <string>

#include "base/trouble.h"

namespace servodx::report {

bool is_refusal(Trouble trouble);  // else a warning: the call goes on
std::string meaning_of(Trouble trouble);
std::string remedy_of(Trouble trouble);

}  // namespace servodx::report
