// MAT logs through matio. All of a file's signals are in memory at once, as matio gives them.
#include <fmt/format.h>
#include <matio.h>

#include <cmath>
#include <cstdint>
#include <memory>

#include "base/sha256.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/log_columns.h"
#include "signals/log_formats.h"

namespace servodx {
namespace {

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using File = std::unique_ptr<mat_t, CloseFile>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

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
  const T* const first = static_cast<const T*>(v.data);
  return {first, first + count_of(v)};
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

class MatReader {
 public:
  MatReader(const std::string& path, const RigFile& rig, const ReadOptions& options)
      : path_(path), log_(path, rig, options, {.has_units = false, .has_lines = false}) {}

  Log read() {
    std::string hash = sha256_of_file(path_);  // refuses what cannot be read
    const File file(Mat_Open(path_.c_str(), MAT_ACC_RDONLY));
    if (!file)
      throw InputError({path_, 0, ""}, "is not a MAT file", "save it with MATLAB's 'save', or write a CSV log");
    while (Variable v{Mat_VarReadNext(file.get())}) take(*v);
    log_.require_signals();
    log_.append_columns({values_.begin(), values_.end()});
    return log_.finish(std::move(hash));
  }

 private:
  void take(matvar_t& v) {
    if (v.class_type == MAT_C_STRUCT && count_of(v) == 1) {
      for (unsigned k = 0; k < Mat_VarGetNumberOfFields(&v); ++k)
        if (const matvar_t* field = Mat_VarGetStructFieldByIndex(&v, k, 0))
          take_signal(fmt::format("{}.{}", v.name, Mat_VarGetStructFieldnames(&v)[k]), *field);
    } else {
      take_signal(v.name ? v.name : "", v);
    }
  }

  void take_signal(const std::string& name, const matvar_t& v) {
    if (log_.add(name, 0) < 0) return;
    std::vector<double> numbers = numbers_of(v);
    if (!is_vector(v) || numbers.size() != count_of(v))
      log_.refuse(0, name,
                  numbers.size() != count_of(v) ? "is not of real numbers"
                                                : fmt::format("is not a vector: it is {}", shape_of(v)),
                  "save each signal as a vector of numbers, one a sample");
    values_.push_back(std::move(numbers));
  }

  const std::string& path_;
  LogColumns log_;
  std::vector<std::vector<double>> values_;  // as in the file, in the order of the log's columns
};

}  // namespace

Log read_mat_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  return MatReader(path, rig, options).read();
}

}  // namespace servodx
