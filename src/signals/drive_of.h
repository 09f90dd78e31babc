// Which of a log's signals drives the valve.
#pragma once
#include "servodx/log.h"

namespace servodx {

// The measured current where the log has it, else the command.
inline Signal drive_of(const Log& log) {
  return log.has(Signal::coil_current) ? Signal::coil_current : Signal::command;
}

}  // namespace servodx
