// Codes of refusals and warnings are part of the library's front door.
#pragma once
#include "servodx/trouble.h"
