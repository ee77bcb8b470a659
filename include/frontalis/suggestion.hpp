#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace frontalis
{

/// Levenshtein distance, whatever the case: smallest number of letters to insert, delete or replace.
inline std::size_t edit_distance(const std::string& a, const std::string& b)
{
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({ replaced, row[j] + 1, row[j + 1] + 1 });
    }
  }
  return row.back();
}

/// " (did you mean 'b'?)" if one of the words is close to `word`, whatever the case of letters, or if
/// two are `word` with "_left" and "_right"; else an empty text.
inline std::string suggestion(const std::string& word, const std::vector<std::string>& words)
{
  if (word.empty())
    return {};
  const auto is_word = [&words](const std::string& other)
  { return std::find(words.begin(), words.end(), other) != words.end(); };
  if (is_word(word + "_left") && is_word(word + "_right"))
    return fmt::format(" (did you mean '{0}_left' or '{0}_right'?)", word);
  const std::string* closest = nullptr;
  std::size_t least = std::max<std::size_t>(word.size() < 4 ? 1 : 2, word.size() / 3) + 1;
  for (const std::string& candidate : words)
    if (const std::size_t distance = edit_distance(word, candidate); distance < least)
    {
      least = distance;
      closest = &candidate;
    }
  return closest == nullptr ? "" : " (did you mean '" + *closest + "'?)";
}

/// "a, b, c" with suggestion(); "none" without words.
inline std::string list_with_suggestion(const std::string& word, const std::vector<std::string>& words)
{
  return words.empty() ? "none" : fmt::format("{}{}", fmt::join(words, ", "), suggestion(word, words));
}

}  // namespace frontalis
