#include "frontalis/model/content_hash.hpp"

#include <fmt/core.h>

#include <cstdint>

namespace frontalis
{

std::string content_hash(const std::string& content)
{
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : content)
    hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  return fmt::format("{:016x}", hash);
}

}  // namespace frontalis
