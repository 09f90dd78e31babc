#include "print_page.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"

namespace servodx {
namespace fs = std::filesystem;
namespace {

// The first of these names in PATH; empty where there is none.
std::string browser() {
  if (const char* named = std::getenv("SERVODX_BROWSER")) return named;
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"}) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const std::string file = folder + "/" + name; ::access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

// A folder of its own, gone with the object: page, PDF and the browser's profile.
struct Workplace {
  fs::path folder;
  Workplace() {
    std::string name = (fs::temp_directory_path() / "servodx-print-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder can be made");
    folder = name;
  }
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
};

bool ran_well(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, words.front().c_str(), &quiet, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 1;
  if (!failed) ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void require_browser() {
  if (!browser().empty()) return;
  throw InputError(
      {"--pdf", 0, ""}, "there is no Chromium on this machine that prints pages",
      "install Debian's package chromium, name a browser in SERVODX_BROWSER, or write --report and print it");
}

void print_page(const std::string& html, const std::string& pdf) {
  const Workplace work;
  const std::string page = (work.folder / "page.html").string(), printed = (work.folder / "page.pdf").string();
  write_file(page, html);
  // Without a sandbox: it needs rights that a container lacks, and the page is our own, which fetches nothing.
  const bool well = ran_well({browser(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                              "--no-first-run", "--disable-background-networking", "--no-pdf-header-footer",
                              "--user-data-dir=" + (work.folder / "profile").string(), "--virtual-time-budget=60000",
                              "--print-to-pdf=" + printed, "file://" + page});
  std::error_code ignored;
  if (!well || !fs::exists(printed, ignored)) throw std::runtime_error(browser() + " did not print the page");
  write_file(pdf, read_file(printed));
}

}  // namespace servodx
