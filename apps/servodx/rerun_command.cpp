// `servodx rerun MANIFEST`: makes a result again and says whether every bit is the same.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/reading_limits.h"
#include "base/sha256.h"
#include "commands.h"
#include "invocation.h"
#include "manifest.h"
#include "read_manifest.h"
#include "report/shared/columns.h"
#include "report/shared/json.h"
#include "servodx/instruction_set.h"

namespace servodx {
namespace fs = std::filesystem;
namespace {

struct Options {
  CommonOptions common;
  std::string manifest;
};

// Manifests of earlier versions lack some keys.
std::string text_or(const report::Json& manifest, const char* key, const std::string& without) {
  return manifest.contains(key) && manifest[key].is_string() ? manifest[key].get<std::string>() : without;
}

void require_same_inputs(const report::Json& manifest) {
  for (const report::Json& input : manifest["inputs"]) {
    const auto path = input.at("path").get<std::string>();
    if (sha256_of_file(path) != input.at("sha256").get<std::string>())
      throw InputError({path, 0, ""}, "has changed since the result was made", "bring back the file as it was");
  }
}

// Runs this program with these arguments; its words go to `words_to`, its progress to standard error.
int run_again(const std::vector<std::string>& arguments, const std::string& words_to) {
  std::vector<std::string> words = {"servodx"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, words_to.c_str(), O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &quiet, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed) throw std::runtime_error("the program cannot start itself");
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : interrupted;
}

std::vector<std::string> texts(const report::Json& list) {
  std::vector<std::string> all;
  for (const report::Json& text : list) all.push_back(text.get<std::string>());
  return all;
}

// What does not go into the result's bytes. A PDF is the page on paper, whose bytes no browser repeats: it is not
// printed again. A checkpoint would give back what is to be made again, and a limit of time that was kept limits
// nothing.
std::vector<std::string> without_aids(const std::vector<std::string>& arguments) {
  constexpr std::string_view options[] = {"--pdf", "--checkpoint", "--time-limit"};
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    const auto is = [&](std::string_view option) { return word == option; };
    const auto has = [&](std::string_view option) {
      return word.starts_with(option) && word.substr(option.size()).starts_with('=');
    };
    if (std::any_of(std::begin(options), std::end(options), is))
      ++i;
    else if (word != "--resume" && std::none_of(std::begin(options), std::end(options), has))
      kept.push_back(arguments[i]);
  }
  return kept;
}

// The files that the call would write, as a rehearsal of it tells; the manifest may be edited.
std::vector<std::string> outputs_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> rehearsal, outputs;
  constexpr std::string_view option = "--json";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (word == option && i + 1 < arguments.size())
      outputs.push_back(arguments[++i]);
    else if (word.starts_with(option) && word.substr(option.size()).starts_with('='))
      outputs.push_back(word.substr(option.size() + 1));
    else
      rehearsal.push_back(word);
  }
  rehearsal.insert(rehearsal.end(), {"--dry-run", "--json", "-"});
  std::string told = (fs::temp_directory_path() / "servodx-rerun-XXXXXX").string();
  const int made = ::mkstemp(told.data());
  if (made < 0) throw std::runtime_error("no temporary file can be made");
  ::close(made);
  run_again(rehearsal, told);
  const auto json = json_or_discarded<report::Json>(read_file_within(told, largest_json));
  fs::remove(told);
  if (json.is_object() && json.contains("outputs"))
    for (const std::string& output : texts(json["outputs"])) outputs.push_back(output);
  std::erase(outputs, "-");
  std::error_code none;
  std::erase_if(outputs, [&](const std::string& o) { return fs::exists(o, none) && !fs::is_regular_file(o, none); });
  return outputs;
}

// What stood there before, to be put back where the new bits are not better.
class Before {
 public:
  void keep(const std::string& path) {
    bytes_[path] = fs::exists(path) ? std::optional(read_file(path)) : std::nullopt;
  }
  void put_back(const std::string& path) const {
    if (const auto& bytes = bytes_.at(path))
      write_file(path, *bytes);
    else
      fs::remove(path);
  }
  bool was_there(const std::string& path) const { return bytes_.at(path).has_value(); }
  bool is_as_it_was(const std::string& path) const {
    const auto& bytes = bytes_.at(path);
    return fs::exists(path) ? bytes && *bytes == read_file(path) : !bytes;
  }

 private:
  std::map<std::string, std::optional<std::string>> bytes_;
};

int run(const Options& options) {
  Invocation invocation("rerun", options.common);
  invocation.check_files({options.manifest}, {});
  const report::Json manifest = read_manifest(options.manifest);
  const std::string manifest_path = fs::absolute(options.manifest).string();
  invocation.header().inputs.push_back({options.manifest, sha256_of_file(options.manifest)});
  if (const auto made_with = manifest["version"].get<std::string>(); made_with != SERVODX_VERSION)
    invocation.note({fmt::format("made with version {}, this is {}", made_with, SERVODX_VERSION)});
  const std::string here = instruction_set(), there = text_or(manifest, "instruction_set", here);
  if (there != here)
    invocation.note({fmt::format("made by {}, this processor runs {}: the last digits may differ", there, here)});
  const fs::path home = fs::current_path();
  fs::current_path(fs::absolute(options.manifest).parent_path() / manifest["directory"].get<std::string>());
  require_same_inputs(manifest);
  if (invocation.dry_run()) return ran;

  Before before;
  before.keep(manifest_path);
  std::set<std::string> listed;
  for (const report::Json& output : manifest["outputs"]) {
    const auto path = output["path"].get<std::string>();
    before.keep(path);
    listed.insert(fs::weakly_canonical(path).string());
  }
  const std::vector<std::string> arguments = without_aids(texts(manifest["arguments"]));
  std::vector<std::string> unlisted = outputs_of(arguments);
  if (!unlisted.empty()) unlisted.push_back(unlisted.front() + manifest_suffix);
  std::erase_if(unlisted,
                [&](const std::string& path) { return listed.contains(fs::weakly_canonical(path).string()); });
  for (const std::string& path : unlisted) before.keep(path);
  const int ended = run_again(arguments, "/dev/null");
  report::Json outputs = report::Json::array();
  report::Columns table("ll", 2);
  bool all_same = true;
  for (const report::Json& output : manifest["outputs"]) {
    const auto path = output["path"].get<std::string>();
    const bool written = fs::exists(path) && ended != refused && ended != failed_inside;
    const std::string again = written ? read_file(path) : "";
    const bool same = written && fingerprint(again) == output["sha256"].get<std::string>();
    all_same = all_same && same;
    if (!same && written) write_file(path + ".rerun", again);
    if (!same || before.was_there(path)) before.put_back(path);
    table.row({same ? "same bits" : "DIFFERS", path + (same || !written ? "" : "; the new one is " + path + ".rerun")});
    outputs.push_back({{"path", path}, {"same", same}});
  }
  for (const std::string& path : unlisted) {
    if (before.is_as_it_was(path)) continue;
    if (!path.ends_with(manifest_suffix)) {
      all_same = false;
      write_file(path + ".rerun", read_file(path));
      table.row({"NOT LISTED", path + " is written and not in the manifest; the new one is " + path + ".rerun"});
      outputs.push_back({{"path", path}, {"same", false}, {"listed", false}});
    }
    before.put_back(path);
  }
  before.put_back(manifest_path);
  fs::current_path(home);
  const auto command = manifest["command"].get<std::string>();
  invocation.finish(
      fmt::format("{} {}\n{}", command, all_same ? "reproduced bit for bit" : "NOT reproduced", table.text()),
      {{"rerun", command}, {"same", all_same}, {"outputs", outputs}});
  return all_same ? ran : ended == interrupted ? interrupted : failed_inside;
}

}  // namespace

void add_rerun_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("rerun", "Make a result again from its manifest and compare every bit");
  command->add_option("MANIFEST", options->manifest, "FILE.manifest.json, beside the result")->required();
  command->footer(
      "Outputs are compared, not overwritten: one that differs is left as FILE.rerun, and the exit code is 1.\n"
      "Of a JSON result, `seconds` is left out of the comparison.");
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
