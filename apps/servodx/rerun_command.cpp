// `servodx rerun MANIFEST`: makes a result again and says whether every bit is the same.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "commands.h"
#include "invocation.h"
#include "manifest.h"
#include "report/columns.h"

namespace servodx {
namespace fs = std::filesystem;
namespace {

struct Options {
  CommonOptions common;
  std::string manifest;
};

report::Json read_manifest(const std::string& path) {
  const report::Json m = report::Json::parse(read_file(path), nullptr, false);
  const auto refuse = [&](const std::string& rule) {
    throw InputError({path, 0, ""}, rule, "name the file FILE.manifest.json beside a result of servodx");
  };
  if (!m.is_object() || !m.contains("manifest")) refuse("is no manifest");
  for (const char* key : {"command", "directory", "arguments", "inputs", "outputs", "version", "interrupted"})
    if (!m.contains(key)) refuse(fmt::format("has no '{}'", key));
  if (m["interrupted"].get<bool>())
    throw InputError({path, 0, "interrupted"}, "that run was interrupted, and where cannot be repeated",
                     "make the result again with its command");
  return m;
}

void require_same_inputs(const report::Json& manifest) {
  for (const report::Json& input : manifest["inputs"]) {
    const auto path = input.at("path").get<std::string>();
    if (sha256_of_file(path) != input.at("sha256").get<std::string>())
      throw InputError({path, 0, ""}, "has changed since the result was made", "bring back the file as it was");
  }
}

// Runs this program with the recorded arguments; its words go nowhere, its progress to standard error.
int run_again(const report::Json& arguments) {
  std::vector<std::string> words = {"servodx"};
  for (const report::Json& a : arguments) words.push_back(a.get<std::string>());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &quiet, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed) throw std::runtime_error("the program cannot start itself");
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : interrupted;
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
  const fs::path home = fs::current_path();
  fs::current_path(fs::absolute(options.manifest).parent_path() / manifest["directory"].get<std::string>());
  require_same_inputs(manifest);
  if (invocation.dry_run()) return ran;

  Before before;
  before.keep(manifest_path);
  for (const report::Json& output : manifest["outputs"]) before.keep(output.at("path").get<std::string>());
  const int ended = run_again(manifest["arguments"]);
  report::Json outputs = report::Json::array();
  report::Columns table("ll", 2);
  bool all_same = true;
  for (const report::Json& output : manifest["outputs"]) {
    const auto path = output.at("path").get<std::string>();
    const bool written = fs::exists(path) && ended != refused && ended != failed_inside;
    const std::string again = written ? read_file(path) : "";
    const bool same = written && fingerprint(again) == output.at("sha256").get<std::string>();
    all_same = all_same && same;
    if (!same && written) write_file(path + ".rerun", again);
    if (!same || before.was_there(path)) before.put_back(path);
    table.row({same ? "same bits" : "DIFFERS", path + (same || !written ? "" : "; the new one is " + path + ".rerun")});
    outputs.push_back({{"path", path}, {"same", same}});
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
