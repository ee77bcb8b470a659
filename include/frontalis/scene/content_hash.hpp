#pragma once

#include <string>

namespace frontalis
{

/// Hash of a text as 16 hexadecimal digits: the short name of Scene::content. FNV-1a with 64 bits (Fowler, Noll and
/// Vo).
std::string content_hash(const std::string& content);

}  // namespace frontalis
