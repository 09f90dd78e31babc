// Logs are part of the library's front door.
#pragma once
#include "servodx/log.h"
#include "signals/signal.h"
