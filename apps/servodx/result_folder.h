// The folder of a list's results: NAME.json a log, or NAME.refused.json with the reason why there is none.
#pragma once
#include <string>

namespace servodx {

// Refuses what is no folder and cannot become one.
void require_folder(const std::string& option, const std::string& folder);

class ResultFolder {
 public:
  explicit ResultFolder(std::string path);  // makes it where it is not there

  std::string result_path(const std::string& name) const;
  std::string page_path(const std::string& name) const;
  std::string refusal_path(const std::string& name) const;

  // Each whole or not at all. Where a result stands no reason does, and the other way round.
  void write_result(const std::string& name, const std::string& text) const;
  void write_refusal(const std::string& name, const std::string& text) const;
  void drop_refusal(const std::string& name) const;
  bool has_page(const std::string& name) const;
  void drop_page(const std::string& name) const;

 private:
  std::string path_;
};

}  // namespace servodx
