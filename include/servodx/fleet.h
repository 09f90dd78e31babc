// Fleet: a folder of results, one a log, as one table. docs/fleet.md.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/diagnose.h"
#include "servodx/watch.h"

namespace servodx {

struct FleetTable;  // the library's own
struct Confusion;

struct Fleet {
  struct Row {
    std::string file, log;  // in the folder; the log's path as the result says
    Verdict::Kind kind = Verdict::Kind::unknown;
    std::string fault;                          // label; empty where none is named
    std::optional<Verdict::Severity> severity;  // 95 %
    double probability = 0;                     // of the fault named, else of the verdict; NaN where none is known
    double error = 0, threshold = 0;            // [deviates] NaN where none is known
  };
  // A log that a list's run set aside, or a file that is no result.
  struct Refused {
    std::string file;
    long line = 0;
    std::string column, rule, mend;
  };
  std::vector<Row> rows;  // worst first: what is not healthy, then by error over threshold, then by path
  std::vector<Refused> refused, unread;
  bool interrupted = false;
  std::size_t without_schema = 0;           // results of earlier versions, read as far as they go
  std::string csv;                          // the table as `servodx gather -o` writes it
  std::shared_ptr<const FleetTable> whole;  // for the program's pages
};
// Throws InputError where the folder is none or holds nothing of a fleet.
Fleet gather_results(const std::string& folder, const Watch& watch = {});

// A truth file: a CSV with the header log,class or log,class,severity.
struct FleetTruth {
  struct Row {
    std::string log, label;
    std::optional<double> severity;  // [the verdict's unit]
    long line = 0;
  };
  std::string path, sha256;
  std::vector<Row> rows;
};

// Throws InputError: a missing column, an empty cell, a log that is named twice.
FleetTruth read_truth(const std::string& path);

// Verdicts beside the truth.
struct FleetCounts {
  struct Rate {
    long counted = 0, of = 0;
  };
  struct OfClass {
    Rate detected;  // not found healthy; of the class healthy these are false alarms
    Rate named;     // by the class's own word
    Rate sized;     // of those named whose truth has a severity: it lies within the interval
  };
  // The probability that was stated of each fault named first, beside how often that name is the truth.
  struct Calibration {
    struct Bin {
      double from = 0, to = 0;  // of the probabilities in it
      double stated = 0;        // their mean
      Rate right;
    };
    std::vector<Bin> bins;        // those that hold any, the least probabilities first
    double stated = 0;            // mean of all; NaN where none was stated
    Rate right;                   // of all
    double error = 0;             // expected calibration error, |stated - right| by bins; NaN where none was stated
    double lower = 0, upper = 1;  // of it, 95 %
    double by_chance = 0;         // 19 of 20 sets of as many logs lie below, where each probability is the true one
  };
  struct Seen {
    Rate found, named;  // not called healthy; by its own label
  };
  // Faults of known size, by how they lie to the least that their logs would have shown (`detectable`).
  struct BesideBound {
    Seen below;        // less than it
    Seen beyond;       // as much or more
    Seen well_beyond;  // of these, as much as 1.2 times or more
    Seen unbounded;    // where not even the worst of the fault would have been shown
  };
  struct DetectableFound {
    struct Band {
      double from = 0, to = 0;  // [true size over the bound] infinite: no end
      Seen seen;
    };
    BesideBound all;
    std::map<std::string, BesideBound> faults;  // by label, those that occur
    std::vector<Band> bands;                    // all of them, of the faults whose bound is known
    double median = 0;                          // [true size over the bound] of those beyond it; NaN where none is
    long unstated = 0;                          // of known size, whose log states no bound of that fault
  };
  std::map<std::string, std::map<std::string, long>> counts;  // [class][what the verdict says]
  std::map<std::string, OfClass> rates;                       // by class
  Calibration calibration;
  DetectableFound detectable;
  long without_truth = 0, without_result = 0;
  std::shared_ptr<const Confusion> whole;  // for the program's pages
};
// Throws InputError where one row of the truth means several logs. `fleet`: as gather_results() made it. `seed`: of the
// logs that are drawn again for the intervals of the calibration.
FleetCounts count_fleet(const Fleet& fleet, const FleetTruth& truth, std::uint64_t seed = 1);
// The truth is read before the folder.
FleetCounts count_fleet(const std::string& folder, const std::string& truth);

}  // namespace servodx
