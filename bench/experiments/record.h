// Trials of one study, a line each: what has been run is kept, so that a study goes on where it was left.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace servodx::experiments {

class Record {
 public:
  // `head`: names of the cells behind the trial's own.
  Record(const std::string& path, const std::string& head) : path_(path) {
    std::ifstream in(path);
    std::string line;
    const bool there = static_cast<bool>(std::getline(in, line));
    while (std::getline(in, line)) {
      std::vector<std::string> cells;
      std::stringstream text(line);
      for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
      if (cells.size() > 1) rows_[cells.front()] = {cells.begin() + 1, cells.end()};
    }
    if (!there) std::ofstream(path) << "trial," << head << '\n';
  }

  bool has(const std::string& trial) const { return rows_.contains(trial); }
  void add(const std::string& trial, const std::vector<std::string>& cells) {
    rows_[trial] = cells;
    const std::string line = fmt::format("{},{}\n", trial, fmt::join(cells, ","));
    std::ofstream(path_, std::ios::app) << line;
    fmt::print("  {}", line);
    std::fflush(stdout);
  }
  const std::map<std::string, std::vector<std::string>>& rows() const { return rows_; }

 private:
  std::string path_;
  std::map<std::string, std::vector<std::string>> rows_;
};

}  // namespace servodx::experiments
