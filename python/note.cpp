// Note: what a result has to say beside its figures.
#include "define.h"
#include "fields.h"
#include "state.h"

namespace servodx::python {

void define_note(py::module_& m) {
  py::class_<Note> note(m, "Note", R"(What a result has to say beside its figures.

Act on its `kind`, read its `text`; str() gives the text.)");
  py::enum_<Note::Kind> kinds(note, "Kind", "What a note is about.");
  for (int k = 0; k < n_note_kinds; ++k) {
    const auto kind = static_cast<Note::Kind>(k);
    kinds.value(std::string(name_of(kind)).c_str(), kind);
  }
  note.def_readonly("kind", &Note::kind)
      .def_readonly("text", &Note::text)
      .def("__str__", [](const Note& n) { return n.text; })
      .def("__repr__", [](const Note& n) { return "<Note " + std::string(name_of(n.kind)) + ": " + n.text + ">"; })
      .def(
          "__eq__", [](const Note& a, const Note& b) { return a == b; }, py::is_operator())
      .def(pickled<Note>());
}

}  // namespace servodx::python
