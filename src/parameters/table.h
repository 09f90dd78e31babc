// The parameter table is part of the library's front door.
#pragma once
#include "parameters/coordinate.h"
#include "parameters/list.h"
#include "servodx/table.h"
