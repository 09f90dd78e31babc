// What stands in the head of every page beside its title: whose valve, which test, whose paper.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "servodx/rig.h"

namespace servodx::report {

struct PageHead {
  std::string logo;                                        // picture as a data URI; empty: none
  std::vector<std::string> lines;                          // name and address of the laboratory, as its own
  std::vector<std::pair<std::string, std::string>> facts;  // "Rig", "bench 3"

  // Sets a fact anew where it is there already; an empty value takes it away.
  void say(const std::string& name, const std::string& value);
};

// Of a rig file: name, serial, oil, supply, and its section [page]; `logo`: the picture it names (store/logo_file.h).
PageHead head_of(const RigFile& rig, std::string logo);

}  // namespace servodx::report
