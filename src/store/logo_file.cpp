#include "store/logo_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>

#include "base/base64.h"
#include "base/csv.h"
#include "base/key_error.h"
#include "servodx/error.h"

namespace servodx::store {
namespace {

constexpr std::size_t largest_logo = 300'000;  // [byte] a page stays small enough for a mail

struct Picture {
  std::string_view ending, type, begins;
};
constexpr std::array<Picture, 4> pictures = {{{".png", "image/png", "\x89PNG"},
                                              {".jpg", "image/jpeg", "\xFF\xD8\xFF"},
                                              {".jpeg", "image/jpeg", "\xFF\xD8\xFF"},
                                              {".svg", "image/svg+xml", "<"}}};

}  // namespace

std::string read_logo(const RigFile& rig) {
  const auto named = rig.words.find("page.logo");
  if (named == rig.words.end() || named->second.empty()) return "";
  const std::string& path = named->second;  // from the rig file
  namespace fs = std::filesystem;
  const std::string file = (fs::path(rig.path).parent_path() / path).string();
  const Place at{rig.path, rig.line("page.logo"), "page.logo"};
  const auto picture = std::find_if(pictures.begin(), pictures.end(),
                                    [&](const Picture& p) { return fs::path(file).extension() == p.ending; });
  if (picture == pictures.end())
    throw key_error(at, "'" + path + "' is no picture that pages show", "give a .png, .jpg or .svg");
  const std::string bytes = read_file(file);
  if (!std::string_view(bytes).starts_with(picture->begins))
    throw key_error(at, "'" + path + "' does not begin as a " + std::string(picture->ending) + " does",
                    "save the picture again, or correct its ending");
  if (bytes.size() > largest_logo)
    throw key_error(at, fmt::format("'{}' has {} bytes, more than {}", path, bytes.size(), largest_logo),
                    "save a smaller picture: 200 pixels high is plenty");
  return "data:" + std::string(picture->type) + ";base64," + base64(bytes);
}

}  // namespace servodx::store
