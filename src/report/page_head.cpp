#include "report/page_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "base/base64.h"
#include "base/csv.h"
#include "base/key_error.h"
#include "report/handy.h"
#include "servodx/error.h"

namespace servodx::report {
namespace {

constexpr std::size_t largest_logo = 300'000;  // [byte] a page stays small enough for a mail

struct Picture {
  std::string_view ending, type, begins;
};
constexpr std::array<Picture, 4> pictures = {{{".png", "image/png", "\x89PNG"},
                                              {".jpg", "image/jpeg", "\xFF\xD8\xFF"},
                                              {".jpeg", "image/jpeg", "\xFF\xD8\xFF"},
                                              {".svg", "image/svg+xml", "<"}}};

// The logo's path is from the rig file.
std::string logo_of(const RigFile& rig, const std::string& path) {
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

std::string word_of(const RigFile& rig, const std::string& key) {
  const auto at = rig.words.find(key);
  return at == rig.words.end() ? "" : at->second;
}

}  // namespace

void PageHead::say(const std::string& name, const std::string& value) {
  const auto at = std::find_if(facts.begin(), facts.end(), [&](const auto& fact) { return fact.first == name; });
  if (at != facts.end() && value.empty())
    facts.erase(at);
  else if (at != facts.end())
    at->second = value;
  else if (!value.empty())
    facts.emplace_back(name, value);
}

PageHead head_of(const RigFile& rig) {
  PageHead head;
  head.say("Rig", rig.name);
  head.say("Serial", rig.serial);
  head.say("Customer", word_of(rig, "page.customer"));
  head.say("Operator", word_of(rig, "page.operator"));
  head.say("Date", word_of(rig, "page.date"));
  if (rig.fluid.given)
    head.say("Fluid", !rig.fluid.name.empty()
                          ? rig.fluid.name
                          : fmt::format("{} mm2/s at 40 degC, {} kg/m3", digits(1e6 * rig.fluid.kinematic_viscosity),
                                        digits(rig.fluid.density, 4)));
  if (const auto supply = rig.fact("supply.pressure")) head.say("Rated supply", handy(*supply, "Pa"));
  std::istringstream lines(word_of(rig, "page.lines"));
  for (std::string line; std::getline(lines, line);) head.lines.push_back(line);
  if (const std::string logo = word_of(rig, "page.logo"); !logo.empty()) head.logo = logo_of(rig, logo);
  return head;
}

}  // namespace servodx::report
