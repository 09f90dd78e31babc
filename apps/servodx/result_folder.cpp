#include "result_folder.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "fleet/result_file.h"
#include "invocation.h"

namespace servodx {

namespace fs = std::filesystem;

void require_folder(const std::string& option, const std::string& folder) {
  std::error_code ignored;
  require_option(!folder.empty(), option, "is required: the folder of the results", option + " results");
  if (fs::is_directory(folder, ignored)) return;
  const fs::path parent = fs::absolute(folder).lexically_normal().parent_path();
  require_option(!fs::exists(folder, ignored), option, "'" + folder + "' is no folder", "name a folder");
  require_option(fs::is_directory(parent, ignored), option, "there is no folder '" + parent.string() + "'",
                 "make that folder, or name another");
}

ResultFolder::ResultFolder(std::string path) : path_(std::move(path)) {
  std::error_code failed;  // another process may make it at the same time
  fs::create_directory(path_, failed);
  if (!fs::is_directory(path_))
    throw InputError({path_, 0, ""}, "cannot be made: " + failed.message(), "make the folder or name another");
}

std::string ResultFolder::result_path(const std::string& name) const { return path_ + "/" + name + result_ending; }
std::string ResultFolder::page_path(const std::string& name) const { return path_ + "/" + name + page_ending; }
std::string ResultFolder::refusal_path(const std::string& name) const { return path_ + "/" + name + refusal_ending; }

void ResultFolder::write_result(const std::string& name, const std::string& text) const {
  write_file(result_path(name), text);
  drop_refusal(name);
}

void ResultFolder::write_refusal(const std::string& name, const std::string& text) const {
  write_file(refusal_path(name), text);
  std::error_code ignored;
  for (const std::string& was : {result_path(name), page_path(name)}) fs::remove(was, ignored);
}

void ResultFolder::drop_refusal(const std::string& name) const {
  std::error_code ignored;
  fs::remove(refusal_path(name), ignored);
}

bool ResultFolder::has_page(const std::string& name) const {
  std::error_code ignored;
  return fs::is_regular_file(page_path(name), ignored);
}

void ResultFolder::drop_page(const std::string& name) const {
  std::error_code ignored;
  fs::remove(page_path(name), ignored);
}

}  // namespace servodx
