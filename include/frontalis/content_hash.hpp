#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <string>

namespace frontalis
{

/// FNV-1a hash (Fowler, Noll and Vo) with 64 bits, as 16 hexadecimal digits. Models store the hash of Scene::content.
inline std::string content_hash(const std::string& content)
{
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : content)
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  return fmt::format("{:016x}", hash);
}

}  // namespace frontalis
