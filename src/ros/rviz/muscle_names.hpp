#pragma once

#include <QString>

#include <algorithm>
#include <string>

namespace frontalis
{

inline bool ends_with(const std::string& text, const std::string& end)
{
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The name of a muscle without its side.
inline std::string stem(const std::string& muscle)
{
  for (const std::string side : { "_left", "_right" })
    if (ends_with(muscle, side))
      return muscle.substr(0, muscle.size() - side.size());
  return muscle;
}

/// The muscle of the other side; empty if the muscle has no side.
inline std::string counterpart(const std::string& muscle)
{
  const bool left = ends_with(muscle, "_left");
  return left || ends_with(muscle, "_right") ? stem(muscle) + (left ? "_right" : "_left") : "";
}

/// A name with spaces instead of underscores.
inline QString words(std::string name)
{
  std::replace(name.begin(), name.end(), '_', ' ');
  return QString::fromStdString(name);
}

}  // namespace frontalis
