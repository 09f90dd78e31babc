// A MAT file without its box: what we make of the sizes in the file, and of whatever the library says is in it.
//
// matio itself is not run: it crashes on bad bytes, which is what the box is for. Here its place is taken by a library
// that draws variables from the input: any class, any rank and dimensions, names and data that may be missing. Only
// what matio owes holds: `dims` has `rank` numbers, `data` has `nbytes` bytes, a cell array or structure as many
// pointers.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "harness.h"
#include "signals/mat_file.h"
#include "signals/matio_library.h"

namespace servodx {
namespace {

// The variables drawn from the bytes, with all that they point to.
class Drawn {
 public:
  explicit Drawn(std::string_view bytes) : bytes_(bytes) {}

  matvar_t* next() { return bytes_.empty() ? nullptr : draw(0); }
  char* const* names_of(const matvar_t* v) {
    const auto fields = static_cast<std::size_t>(v->nbytes / sizeof(matvar_t*));
    names_.emplace_back();
    for (std::size_t k = 0; k < fields; ++k) names_.back().push_back(byte() % 8 == 0 ? nullptr : text());
    names_.back().push_back(nullptr);
    return byte() % 16 == 0 ? nullptr : names_.back().data();
  }

 private:
  unsigned byte() {
    if (bytes_.empty()) return 0;
    const auto b = static_cast<unsigned char>(bytes_.front());
    bytes_.remove_prefix(1);
    return b;
  }
  char* text() {
    texts_.emplace_back();
    for (unsigned n = byte() % 8; n > 0; --n) texts_.back() += static_cast<char>(byte());
    return texts_.back().data();
  }
  // Small as a rule, now and then as large as a damaged file may claim.
  std::size_t extent() {
    const unsigned b = byte();
    return b < 200 ? b % 32 : b < 250 ? b : SIZE_MAX / (b - 249);
  }

  matvar_t* draw(int depth) {
    matvar_t& v = variables_.emplace_back();
    v.name = byte() % 8 == 0 ? nullptr : text();
    v.class_type = static_cast<matio_classes>(byte() % 20);
    v.data_type = static_cast<matio_types>(byte() % 20);
    v.isComplex = byte() % 8 == 0;
    v.rank = static_cast<int>(byte() % 4);
    dims_.emplace_back();
    for (int k = 0; k < v.rank; ++k) dims_.back().push_back(extent());
    v.dims = byte() % 16 == 0 ? nullptr : dims_.back().data();
    v.data_size = static_cast<int>(byte() % 10);
    const bool holds_others = v.class_type == MAT_C_CELL || v.class_type == MAT_C_STRUCT;
    holds_others ? fill_with_others(v, depth) : fill_with_bytes(v);
    return &v;
  }
  // As many as its dimensions say, as matio makes them.
  void fill_with_others(matvar_t& v, int depth) {
    std::size_t count = v.dims ? 1 : 0;
    for (int k = 0; v.dims && k < v.rank; ++k) count *= std::min<std::size_t>(v.dims[k] = v.dims[k] % 8, 8);
    others_.emplace_back();
    for (std::size_t k = 0; k < count; ++k)
      others_.back().push_back(depth > 2 || byte() % 8 == 0 ? nullptr : draw(depth + 1));
    v.data_size = sizeof(matvar_t*);
    v.nbytes = count * sizeof(matvar_t*);
    v.data = byte() % 16 == 0 ? nullptr : others_.back().data();
  }
  void fill_with_bytes(matvar_t& v) {
    std::size_t count = static_cast<std::size_t>(v.data_size);
    for (int k = 0; v.dims && k < v.rank; ++k) count *= v.dims[k];
    const bool as_said = count <= 4096 && byte() % 4 != 0;
    data_.push_back(std::make_unique<char[]>(v.nbytes = as_said ? count : byte()));
    const std::size_t there = std::min(bytes_.size(), v.nbytes);
    std::memcpy(data_.back().get(), bytes_.data(), there);
    bytes_.remove_prefix(there);
    v.data = byte() % 16 == 0 ? nullptr : data_.back().get();
  }

  std::string_view bytes_;
  std::deque<matvar_t> variables_;
  std::deque<std::string> texts_;
  std::deque<std::vector<std::size_t>> dims_;
  std::deque<std::vector<matvar_t*>> others_;
  std::deque<std::vector<char*>> names_;
  std::vector<std::unique_ptr<char[]>> data_;
};

Drawn* drawn = nullptr;

matvar_t* field_of(matvar_t* v, std::size_t field, std::size_t) {
  return v->data && field < v->nbytes / sizeof(matvar_t*) ? static_cast<matvar_t**>(v->data)[field] : nullptr;
}

const MatioLibrary library = {
    .open = [](const char*, int) { return reinterpret_cast<mat_t*>(drawn); },
    .close = [](mat_t*) { return 0; },
    .read_next = [](mat_t*) { return drawn->next(); },
    .free_variable = [](matvar_t*) {},
    .number_of_fields = [](matvar_t* v) { return static_cast<unsigned>(v->nbytes / sizeof(matvar_t*)); },
    .field_names = [](const matvar_t* v) { return drawn->names_of(v); },
    .field = field_of,
};

}  // namespace

// In the place of the library's own.
void load_matio(const std::string&) {}
const MatioLibrary& matio() { return library; }

void fuzz::read(std::string_view input) {
  // The file's own sizes first; what the library says follows the header and so does not depend on them.
  const InputFile file(input);
  Drawn all(input.size() > 128 ? input.substr(128) : input);
  drawn = &all;
  refusing([&] { read_mat_file(file.path(), [](const MatVariable&) {}); });
  static const std::string level_73 = std::string(124, ' ') + std::string("\0\2IM", 4);
  const InputFile accepted(level_73);
  Drawn again(input);
  drawn = &again;
  read_mat_file(accepted.path(), [](const MatVariable&) {});
}

}  // namespace servodx
