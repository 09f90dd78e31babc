// servodx: faults of electrohydraulic servovalves from rig logs. All of the library; docs/library.md tells how to use
// it.
#pragma once
#include "servodx/baseline.h"
#include "servodx/diagnose.h"
#include "servodx/error.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/plan.h"
#include "servodx/rig.h"
#include "servodx/simulate.h"
#include "servodx/stepper.h"
#include "servodx/table.h"
#include "servodx/trend.h"
#include "servodx/trouble.h"
#include "servodx/tune.h"
#include "servodx/watch.h"
