// Apart from the estimate: who reads a history needs no simulation.
#include "prognose/oil_temperature.h"

namespace servodx {

const char* name_of(OilSource source) {
  switch (source) {
    case OilSource::given:
      return "given";
    case OilSource::estimated:
      return "estimated";
    case OilSource::assumed:
      return "assumed";
  }
  return "";
}

}  // namespace servodx
