#pragma once

#include "files.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace frontalis
{

/// A skin that `frontalis run` has written.
struct Ply
{
  std::vector<std::array<float, 6>> vertices;  ///< position, normal
  std::vector<std::array<std::int32_t, 3>> triangles;
};

inline std::size_t count_in(const std::string& header, const std::string& element)
{
  const std::size_t place = header.find("element " + element + " ");
  return place == std::string::npos ? 0 : std::stoul(header.substr(place + 9 + element.size()));
}

inline Ply read_ply(const std::string& path)
{
  const std::string bytes = text_of(path);
  const std::string end = "end_header\n";
  const std::size_t body = bytes.find(end) + end.size();
  const std::string header = bytes.substr(0, body);
  EXPECT_EQ(header.compare(0, 37, "ply\nformat binary_little_endian 1.0\nc"), 0) << path;
  Ply ply;
  ply.vertices.resize(count_in(header, "vertex"));
  ply.triangles.resize(count_in(header, "face"));
  EXPECT_EQ(bytes.size(), body + 24 * ply.vertices.size() + 13 * ply.triangles.size()) << path;
  if (testing::Test::HasFailure())
    return {};
  const char* place = bytes.data() + body;
  for (auto& vertex : ply.vertices)
  {
    std::memcpy(vertex.data(), place, 24);
    place += 24;
  }
  for (auto& triangle : ply.triangles)
  {
    EXPECT_EQ(*place, 3);
    std::memcpy(triangle.data(), place + 1, 12);
    place += 13;
  }
  return ply;
}

}  // namespace frontalis
