// A notice beside a result: what it is about, and its words. No code reads the words.
#pragma once
#include <string>
#include <vector>

namespace servodx {

enum class NoteKind {
  data,         // what a reader left out or found implausible
  assumption,   // what was taken for granted because the data do not say it
  finding,      // what the result says beside its figures
  convergence,  // how a search ended
  file,         // an older form of a file, an other place
};

struct Note {
  NoteKind kind = NoteKind::data;
  std::string text;
};
using Notes = std::vector<Note>;

}  // namespace servodx
