#include "scene/suggestion.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace frontalis
{
namespace
{

// Levenshtein distance: fewest letters inserted, deleted or replaced
std::size_t edit_distance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({ replaced, row[j] + 1, row[j + 1] + 1 });
    }
  }
  return row.back();
}

}  // namespace

std::string list_with_suggestion(const std::string& word, const std::vector<std::string>& words)
{
  std::string text;
  const std::string* closest = nullptr;
  std::size_t least = std::max<std::size_t>(word.size() < 4 ? 1 : 2, word.size() / 3) + 1;
  for (const std::string& candidate : words)
  {
    text += (text.empty() ? "" : ", ") + candidate;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least)
    {
      least = distance;
      closest = &candidate;
    }
  }
  if (closest != nullptr)
    text += " (did you mean '" + *closest + "'?)";
  return text.empty() ? "none" : text;
}

}  // namespace frontalis
