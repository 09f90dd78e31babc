#include "signals/matio_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/error.h"

namespace servodx {
namespace {

MatioLibrary library;

// The version whose header this was compiled with: another may lay its structs out in another way.
constexpr const char* file_name = SERVODX_MATIO_LIBRARY;

template <class Function>
bool link(void* loaded, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(loaded, name));
  return function != nullptr;
}

bool link_all(void* loaded, MatioLibrary& found) {
  return link(loaded, "Mat_Open", found.open) && link(loaded, "Mat_Close", found.close) &&
         link(loaded, "Mat_VarReadNext", found.read_next) && link(loaded, "Mat_VarFree", found.free_variable) &&
         link(loaded, "Mat_VarGetNumberOfFields", found.number_of_fields) &&
         link(loaded, "Mat_VarGetStructFieldnames", found.field_names) &&
         link(loaded, "Mat_VarGetStructFieldByIndex", found.field);
}

}  // namespace

void load_matio(const std::string& path) {
  if (library.open) return;
  // All symbols at once: behind the filter of system calls nothing is loaded.
  void* const loaded = ::dlopen(file_name, RTLD_NOW | RTLD_LOCAL);
  MatioLibrary found;
  if (!loaded || !link_all(loaded, found))
    throw InputError({path, 0, ""}, fmt::format("cannot be read here: the library {} is missing or damaged", file_name),
                     "install it (Debian: 'apt install " SERVODX_MATIO_PACKAGE "'), or write a CSV log");
  library = found;
}

const MatioLibrary& matio() { return library; }

}  // namespace servodx
