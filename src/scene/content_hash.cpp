#include "frontalis/scene/content_hash.hpp"

#include <fmt/format.h>

namespace frontalis
{

void ContentHash::add(const void* bytes, std::size_t size)
{
  const auto* byte = static_cast<const unsigned char*>(bytes);
  std::uint64_t value = value_;
  for (std::size_t i = 0; i < size; ++i)
    value = (value ^ byte[i]) * 1099511628211ULL;
  value_ = value;
}

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

std::string content_hash(const std::string& content)
{
  ContentHash hash;
  hash.add(content.data(), content.size());
  return hash.text();
}

}  // namespace frontalis
