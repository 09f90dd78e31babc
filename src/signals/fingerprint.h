// Which log it is: by the bytes of its file, or by its samples, which a log from memory has too.
#pragma once
#include <string_view>

namespace servodx {

struct Fingerprint {
  std::string_view sha256;   // of the file's bytes; empty: none
  std::string_view content;  // content_hash; empty: an earlier version did not keep it
};

inline bool is_same_log(const Fingerprint& a, const Fingerprint& b) {
  return (!a.sha256.empty() && a.sha256 == b.sha256) || (!a.content.empty() && a.content == b.content);
}

}  // namespace servodx
