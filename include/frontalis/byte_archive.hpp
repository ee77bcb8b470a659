#pragma once

#include "frontalis/error.hpp"

#include <array>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace frontalis
{

/// Writes plain values to bytes, or reads them back in the same order, so that one list of fields serves both:
/// archive(a)(b)(c). The bytes are those in memory, so that only the same kind of machine can read them.
class ByteArchive
{
public:
  ByteArchive() = default;  ///< an archive to write values to
  /// An archive to read values from.
  explicit ByteArchive(std::string bytes) : reads_(true), bytes_(std::move(bytes)) {}

  bool reads() const { return reads_; }
  bool ended() const { return at_ == bytes_.size(); }
  const std::string& bytes() const { return bytes_; }

  /// Writes or reads a value. When reading, throws an Error if the bytes end too early.
  template <class T>
  ByteArchive& operator()(T& value)
  {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    copy(&value, sizeof(T));
    return *this;
  }
  ByteArchive& operator()(std::string& text) { return values(text); }
  template <class T>
  ByteArchive& operator()(std::vector<T>& list)
  {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    return values(list);
  }
  template <class T, std::size_t N>
  ByteArchive& operator()(std::array<std::vector<T>, N>& lists)
  {
    for (auto& list : lists)
      values(list);
    return *this;
  }

private:
  template <class List>
  ByteArchive& values(List& list)
  {
    constexpr std::size_t size = sizeof(typename List::value_type);
    std::size_t count = list.size();
    copy(&count, sizeof count);
    if (reads_ && count > (bytes_.size() - at_) / size)
      throw Error("truncated");
    list.resize(count);
    copy(list.data(), count * size);
    return *this;
  }
  void copy(void* value, std::size_t size)
  {
    if (!reads_)
      bytes_.append(static_cast<const char*>(value), size);
    else if (size > bytes_.size() - at_)
      throw Error("truncated");
    else if (size > 0)
      std::memcpy(value, bytes_.data() + at_, size);
    at_ += size;
  }

  bool reads_ = false;
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace frontalis
