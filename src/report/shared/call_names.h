// How the files of a call are named in the calls that its result advises: words in capitals where they are not known.
#pragma once
#include <string>

namespace servodx::report {

struct CallNames {
  std::string rig = "RIG.toml";  // empty: the call had none
  std::string table = "TUNED";
  std::string baseline = "BASE.json";
};

// As a shell takes it for one word.
std::string shell_word(const std::string& text);

}  // namespace servodx::report
