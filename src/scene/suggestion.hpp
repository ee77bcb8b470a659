#pragma once

#include <string>
#include <vector>

namespace frontalis
{

/// "a, b, c", followed by " (did you mean 'b'?)" if one of the words is close to `word`; "none" without words.
std::string list_with_suggestion(const std::string& word, const std::vector<std::string>& words);

}  // namespace frontalis
