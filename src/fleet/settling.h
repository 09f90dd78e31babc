// Which files of a folder have come to rest: a recorder that still writes must not be read.
//
// A file has settled once its size and time have not changed for a while, by this program's clock: clocks of file
// servers may differ. A file that changes later settles again.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace servodx {

struct SeenFile {
  std::string name;  // in the folder
  std::uintmax_t size = 0;
  std::filesystem::file_time_type time = {};
};

// Files of the folder whose ending is one of a log (.csv .txt .tsv .dat .mat), hidden ones left out, by name. Throws
// InputError where it is no folder. Folders inside are not entered.
std::vector<SeenFile> logs_in(const std::string& folder);

class Settling {
 public:
  explicit Settling(double seconds) : seconds_(seconds) {}

  // Names of those that have settled by `now` [s] and were not named as they are; what is not seen is forgotten.
  std::vector<std::string> settled(const std::vector<SeenFile>& seen, double now);
  std::size_t unsettled() const;  // of those last seen

 private:
  struct State {
    std::uintmax_t size;
    std::filesystem::file_time_type time;
    double since;  // [s]
    bool named = false;
  };
  double seconds_;
  std::map<std::string, State> states_;
};

}  // namespace servodx
