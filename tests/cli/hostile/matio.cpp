// Stands in for libmatio in tests: does what its file's first variable is named after.
#include <matio.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

void do_as_told(const std::string& deed) {
  if (deed == "socket") ::socket(AF_INET, SOCK_STREAM, 0);
  if (deed == "program") ::execl("/bin/touch", "touch", "made", nullptr);
  if (deed == "crash") std::abort();
  for (volatile bool more = deed == "loop"; more;) {
  }
  while (deed == "memory")
    if (void* piece = std::malloc(std::size_t{16} << 20))
      std::memset(piece, 1, std::size_t{16} << 20);
    else
      throw std::bad_alloc();
}

}  // namespace

extern "C" {

mat_t* Mat_Open(const char* path, int) {
  char bytes[64] = {};
  if (std::FILE* file = std::fopen(path, "rb")) {
    const std::size_t n = std::fread(bytes, 1, sizeof bytes - 1, file);
    std::fclose(file);
    if (n > 20) do_as_told(bytes + 20);
  }
  static char stands_for_a_file;
  return reinterpret_cast<mat_t*>(&stands_for_a_file);
}
int Mat_Close(mat_t*) { return 0; }
matvar_t* Mat_VarReadNext(mat_t*) { return nullptr; }
void Mat_VarFree(matvar_t*) {}
unsigned Mat_VarGetNumberOfFields(matvar_t*) { return 0; }
char* const* Mat_VarGetStructFieldnames(const matvar_t*) { return nullptr; }
matvar_t* Mat_VarGetStructFieldByIndex(matvar_t*, size_t, size_t) { return nullptr; }

}  // extern "C"
