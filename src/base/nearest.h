// "did you mean ...": the known word nearest to one that is not known.
//
// Edit distance: letters changed, left out, put in, and neighbours swapped; upper case is no difference. A third of the
// letters may differ, as beyond that another word was meant.
#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace servodx {

inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + !same(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

// Empty where none is near.
template <class Words>
std::string nearest_word(std::string_view word, const Words& known) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const auto& each : known)
    if (const std::size_t d = edit_distance(word, each); d < least) least = d, best = std::string(each);
  return best;
}

// All that are near, nearest first.
template <class Words>
std::vector<std::string> near_words(std::string_view word, const Words& known) {
  std::vector<std::string> near;
  for (const auto& each : known)
    if (edit_distance(word, each) <= std::max<std::size_t>(1, word.size() / 3)) near.emplace_back(each);
  std::stable_sort(near.begin(), near.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(word, a) < edit_distance(word, b);
  });
  return near;
}

// "did you mean 'rated_current'? " where one is near, else nothing: stands before the list of what is known.
template <class Words>
std::string did_you_mean(std::string_view word, const Words& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? "" : "did you mean '" + near + "'? ";
}

}  // namespace servodx
