#include "servodx/note.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace servodx {
namespace {

TEST(Note, EveryKindHasAWordOfItsOwn) {
  std::set<std::string_view> words;
  for (int k = 0; k < n_note_kinds; ++k) {
    const std::string_view word = name_of(static_cast<Note::Kind>(k));
    EXPECT_FALSE(word.empty()) << k;
    EXPECT_TRUE(words.insert(word).second) << word << " stands twice";
  }
}

TEST(Note, IsTheSameByKindAndWords) {
  const Note note{Note::Kind::gaps, "2 gaps"};
  EXPECT_EQ(note, (Note{Note::Kind::gaps, "2 gaps"}));
  EXPECT_NE(note, (Note{Note::Kind::gaps, "3 gaps"}));
  EXPECT_NE(note, (Note{Note::Kind::left_out, "2 gaps"}));
  EXPECT_EQ(texts_of({note, {Note::Kind::oil, "cold"}}), (std::vector<std::string>{"2 gaps", "cold"}));
}

}  // namespace
}  // namespace servodx
