// Errors of the boundary are part of the library's front door.
#pragma once
#include "servodx/error.h"
