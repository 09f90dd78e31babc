// What all text for Prometheus is made of: heads of gauges, and labels. Source: Prometheus text format 0.0.4.
#pragma once
#include <string>

namespace servodx::prometheus {

std::string label(const std::string& value);  // quoted, with what it may not hold escaped
// Of a metric, before its first value.
void head(std::string& text, const char* name, const char* help);

}  // namespace servodx::prometheus
