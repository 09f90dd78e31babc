#include "signals/log.h"

#include <algorithm>
#include <cctype>

#include "servodx/rig.h"
#include "signals/log_formats.h"

namespace servodx {

Log read_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  std::string ending = path.substr(path.size() - std::min<std::size_t>(4, path.size()));
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".mat" ? read_mat_log(path, rig, options) : read_csv_log(path, rig, options);
}

}  // namespace servodx
