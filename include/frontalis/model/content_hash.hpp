#pragma once

#include <string>

namespace frontalis
{

/// FNV-1a hash (Fowler, Noll and Vo) with 64 bits, as 16 hexadecimal digits. Models store the hash of Scene::content.
std::string content_hash(const std::string& content);

}  // namespace frontalis
