// Results as JSON, key by key as the contract names them; further keys may follow. Numbers are SI unless a `unit`
// stands beside them; what is not finite becomes null.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evidence/conditions.h"
#include "report/shared/call_names.h"
#include "report/shared/held_json.h"
#include "report/shared/page_head.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx::report {

using Json = nlohmann::ordered_json;

struct InputFile {
  std::string path, sha256;
};

// What every result file begins with.
struct Header {
  std::string version, command;
  std::string commit = {};  // of the program's sources, where a result is kept while it is the same; else empty
  std::uint64_t seed = 1;
  HeldJson settings;  // the options in effect that a result depends on; the number of threads is none
  std::vector<InputFile> inputs;
  double seconds = 0;  // [s] wall time
  long simulations = 0, failed_simulations = 0;
  std::vector<std::string> notes;
  PageHead head;  // of pages alone
  CallNames call = {};
};

Json number(double value);  // null where it is not finite: JSON has no word for it
Json to_json(const Header& header);
Json to_json(const ParameterResult& parameter);
Json to_json(const ChannelResult& channel);
Json to_json(const std::vector<ChannelResult>& channels);
Json test_json(const TestConditions& test);

// Header, then body; ends in a line end. Bytes that are no UTF-8 (in paths) are replaced.
std::string dump(const Header& header, const Json& body);

}  // namespace servodx::report
