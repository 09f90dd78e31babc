#include "signals/mat_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "signals/matio_library.h"

namespace servodx {
namespace {

constexpr const char* save_again = "copy or save it again, or write a CSV log";

struct CloseFile {
  void operator()(mat_t* file) const { matio().close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { matio().free_variable(variable); }
};
using File = std::unique_ptr<mat_t, CloseFile>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// The outermost parts of a file against its size: matio reads what is not there as it finds its memory.
class Parts {
 public:
  explicit Parts(const std::string& path) : path_(path), file_(path, std::ios::binary | std::ios::ate) {
    size_ = static_cast<std::uint64_t>(file_.tellg());
  }

  // How many variables the file says it has; none where only HDF5 can say (level 7.3).
  std::optional<long> count() {
    unsigned char head[header_size] = {};
    if (get(0, head, sizeof head)) {
      const bool little = head[126] == 'I' && head[127] == 'M', big = head[126] == 'M' && head[127] == 'I';
      if (little || big) {
        swapped_ = big;
        const unsigned version = swapped_ ? head[124] : head[125];
        return version == 1 ? std::optional(count_elements()) : std::nullopt;
      }
    }
    return count_matrices();
  }

 private:
  static constexpr std::uint64_t header_size = 128;  // of level 5

  bool get(std::uint64_t at, void* to, std::size_t bytes) {
    if (at + bytes > size_) return false;
    file_.seekg(static_cast<std::streamoff>(at));
    return static_cast<bool>(file_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)));
  }

  std::uint32_t word(std::uint64_t at) {
    unsigned char b[4] = {};
    if (!get(at, b, sizeof b)) cut_off(at);
    if (swapped_) return b[3] | b[2] << 8 | b[1] << 16 | static_cast<std::uint32_t>(b[0]) << 24;
    return b[0] | b[1] << 8 | b[2] << 16 | static_cast<std::uint32_t>(b[3]) << 24;
  }

  [[noreturn]] void cut_off(std::uint64_t at) const {
    throw InputError(
        {path_, 0, ""},
        fmt::format("is cut off or damaged: what begins at byte {} does not end within its {} bytes", at, size_),
        save_again);
  }

  // Level 5: elements of a type, a length and so many bytes.
  long count_elements() {
    constexpr std::uint32_t matrix = 14, compressed = 15;
    long count = 0;
    for (std::uint64_t at = header_size; at < size_; ++count) {
      const std::uint32_t type = word(at), length = word(at + 4);
      if (type != matrix && type != compressed)
        throw InputError({path_, 0, ""}, fmt::format("is damaged: what begins at byte {} is no variable", at),
                         save_again);
      if (length > size_ - at - 8) cut_off(at);
      at += 8 + std::uint64_t{length};
    }
    return count;
  }

  // Level 4: a header of five words, the name, then the real and the imaginary part.
  long count_matrices() {
    constexpr std::uint64_t words = 20;
    constexpr double bytes[] = {8, 4, 4, 2, 2, 1};
    constexpr std::uint32_t greatest_type = 4052;  // orders of bytes, precisions and kinds of matrix in decimal digits
    long count = 0;
    for (std::uint64_t at = 0; at < size_; ++count) {
      swapped_ = false;
      if (word(at) > greatest_type) swapped_ = true;
      const std::uint32_t type = word(at), precision = type / 10 % 10;
      if (type > greatest_type || precision > 5)
        throw InputError({path_, 0, ""}, "is not a MAT file", "save it with MATLAB's 'save', or write a CSV log");
      const double parts = word(at + 12) != 0 ? 2 : 1;
      const double length = parts * bytes[precision] * word(at + 4) * word(at + 8) + word(at + 16);
      if (size_ - at < words || length > static_cast<double>(size_ - at - words)) cut_off(at);
      at += words + static_cast<std::uint64_t>(length);
    }
    return count;
  }

  const std::string& path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  bool swapped_ = false;
};

std::string shape_of(const matvar_t& v) {
  std::string shape;
  for (int k = 0; k < v.rank; ++k) shape += (k ? " x " : "") + std::to_string(v.dims[k]);
  return shape;
}

std::size_t count_of(const matvar_t& v) {
  std::size_t count = 1;
  for (int k = 0; k < v.rank; ++k) count *= v.dims[k];
  return count;
}

bool is_vector(const matvar_t& v) { return v.rank == 2 && (v.dims[0] == 1 || v.dims[1] == 1); }

template <class T>
std::vector<double> numbers_as(const matvar_t& v) {
  const std::size_t count = count_of(v);
  if (v.data_size != sizeof(T) || v.nbytes / sizeof(T) != count) return {};
  const T* const first = static_cast<const T*>(v.data);
  return {first, first + count};
}

// Empty where the class is not one of real numbers.
std::vector<double> numbers_of(const matvar_t& v) {
  if (v.isComplex || !v.data) return {};
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      return numbers_as<double>(v);
    case MAT_C_SINGLE:
      return numbers_as<float>(v);
    case MAT_C_INT8:
      return numbers_as<std::int8_t>(v);
    case MAT_C_UINT8:
      return numbers_as<std::uint8_t>(v);
    case MAT_C_INT16:
      return numbers_as<std::int16_t>(v);
    case MAT_C_UINT16:
      return numbers_as<std::uint16_t>(v);
    case MAT_C_INT32:
      return numbers_as<std::int32_t>(v);
    case MAT_C_UINT32:
      return numbers_as<std::uint32_t>(v);
    case MAT_C_INT64:
      return numbers_as<std::int64_t>(v);
    case MAT_C_UINT64:
      return numbers_as<std::uint64_t>(v);
    default:
      return {};
  }
}

MatVariable variable_of(const std::string& name, const matvar_t& v) {
  MatVariable out{name, "", {}};
  if (!v.dims || v.rank < 1 || !is_vector(v)) {
    out.fault = v.dims && v.rank > 0 ? fmt::format("is not a vector: it is {}", shape_of(v)) : "is not a vector";
    return out;
  }
  out.numbers = numbers_of(v);
  if (out.numbers.size() != count_of(v)) out.fault = "is not of real numbers";
  return out;
}

// A text of matio's, of one byte or two a letter, in UTF-8; `step` letters apart.
std::string text_of(const matvar_t& v, std::size_t first, std::size_t step, std::size_t letters) {
  std::string text;
  if (!v.data || (v.data_size != 1 && v.data_size != 2)) return {};
  const std::size_t there = v.nbytes / static_cast<std::size_t>(v.data_size);
  for (std::size_t k = 0, at = first; k < letters; ++k, at += step) {
    unsigned code = 0;
    if (at >= there) return {};
    if (v.data_size == 1)
      code = static_cast<const unsigned char*>(v.data)[at];
    else
      code = static_cast<const std::uint16_t*>(v.data)[at];
    if (code < 0x80 || v.data_type == MAT_T_UTF8) {
      text += static_cast<char>(code);
    } else if (code < 0x800) {
      text += static_cast<char>(0xC0 | code >> 6);
      text += static_cast<char>(0x80 | (code & 0x3F));
    } else {
      text += static_cast<char>(0xE0 | code >> 12);
      text += static_cast<char>(0x80 | (code >> 6 & 0x3F));
      text += static_cast<char>(0x80 | (code & 0x3F));
    }
  }
  text.erase(text.find_last_not_of(std::string_view(" \0", 2)) + 1);
  return text;
}

constexpr std::size_t most_columns = 100;  // of a matrix of signals; more is no log

// The texts of a cell array, or the rows of a matrix of letters; empty where it is neither, or names more than a matrix
// may have. (A matrix of a billion rows of no letters takes no byte of its file.)
std::vector<std::string> texts_of(const matvar_t& v) {
  std::vector<std::string> texts;
  if (!v.dims || v.rank != 2 || v.dims[0] > most_columns || v.dims[1] > v.nbytes) return {};
  if (v.class_type == MAT_C_CHAR) {
    for (std::size_t row = 0; row < v.dims[0]; ++row) texts.push_back(text_of(v, row, v.dims[0], v.dims[1]));
  } else if (v.class_type == MAT_C_CELL && v.data && count_of(v) <= v.nbytes / sizeof(matvar_t*)) {
    for (std::size_t k = 0; k < count_of(v); ++k) {
      const matvar_t* cell = static_cast<matvar_t* const*>(v.data)[k];
      if (!cell || cell->class_type != MAT_C_CHAR || !cell->dims || cell->rank < 1) return {};
      texts.push_back(text_of(*cell, 0, 1, count_of(*cell)));
    }
  }
  return texts;
}

// Matrices whose columns may be signals, and lists that may name them.
class Matrices {
 public:
  void add(const std::string& name, const matvar_t& v) {
    if (!v.dims || v.rank != 2) return;
    if (auto texts = texts_of(v); texts.size() > 1) {
      lists_.push_back(std::move(texts));
      return;
    }
    const std::size_t rows = v.dims[0], columns = v.dims[1];
    const std::size_t most = std::max(rows, columns), least = std::min(rows, columns);
    if (least < 2 || least > most_columns || most < fewest_samples) return;
    if (std::vector<double> numbers = numbers_of(v); numbers.size() == count_of(v))
      matrices_.push_back({name, rows, columns, std::move(numbers)});
  }

  void give(const std::function<void(const MatVariable&)>& take) const {
    for (const Matrix& m : matrices_) {
      const bool standing = m.rows >= m.columns;
      const std::size_t signals = standing ? m.columns : m.rows, samples = standing ? m.rows : m.columns;
      const auto names = std::find_if(lists_.begin(), lists_.end(), [&](const auto& l) { return l.size() == signals; });
      for (std::size_t k = 0; k < signals; ++k) {
        MatVariable v{names != lists_.end() ? (*names)[k]
                      : standing            ? fmt::format("{}(:,{})", m.name, k + 1)
                                            : fmt::format("{}({},:)", m.name, k + 1),
                      "",
                      {}};
        for (std::size_t i = 0; i < samples; ++i)
          v.numbers.push_back(m.numbers[standing ? k * m.rows + i : i * m.rows + k]);
        take(v);
      }
    }
  }

 private:
  static constexpr std::size_t fewest_samples = 20;  // else it is no log
  struct Matrix {
    std::string name;
    std::size_t rows, columns;
    std::vector<double> numbers;  // column by column
  };
  std::vector<Matrix> matrices_;
  std::vector<std::vector<std::string>> lists_;
};

}  // namespace

void read_mat_file(const std::string& path, const std::function<void(const MatVariable&)>& take) {
  load_matio(path);
  const std::optional<long> expected = Parts(path).count();
  const File file(matio().open(path.c_str(), MAT_ACC_RDONLY));
  if (!file) throw InputError({path, 0, ""}, "is not a MAT file", "save it with MATLAB's 'save', or write a CSV log");
  Matrices matrices;
  const auto take_variable = [&](const std::string& name, const matvar_t& v) {
    matrices.add(name, v);
    take(variable_of(name, v));
  };
  long read = 0;
  for (; Variable v{matio().read_next(file.get())}; ++read) {
    const std::string name = v->name ? v->name : "";
    const bool one_deep = v->class_type == MAT_C_STRUCT && v->dims && v->rank > 0 && count_of(*v) == 1;
    char* const* const names = one_deep ? matio().field_names(v.get()) : nullptr;
    if (!names) {
      take_variable(name, *v);
      continue;
    }
    for (unsigned k = 0; k < matio().number_of_fields(v.get()); ++k)
      if (const matvar_t* field = matio().field(v.get(), k, 0); field && names[k])
        take_variable(fmt::format("{}.{}", name, names[k]), *field);
  }
  if (expected && read < *expected)
    throw InputError({path, 0, ""},
                     fmt::format("is damaged: its variable {} of {} cannot be read", read + 1, *expected), save_again);
  matrices.give(take);
}

}  // namespace servodx
