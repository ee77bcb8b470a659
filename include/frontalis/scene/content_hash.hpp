#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace frontalis
{

/// FNV-1a, 64 bits (Fowler, Noll and Vo), over bytes given piece by piece.
class ContentHash
{
public:
  void add(const void* bytes, std::size_t size);
  std::uint64_t value() const { return value_; }
  std::string text() const;  ///< 16 hexadecimal digits

private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

/// Hash of a text, as 16 hexadecimal digits: short name of Scene::content.
std::string content_hash(const std::string& content);

}  // namespace frontalis
