#include "cli/frame_folder.hpp"

#include "frontalis/error.hpp"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <utility>

namespace frontalis
{
namespace
{

void append_little_endian(std::string& bytes, std::uint32_t value)
{
  for (int shift = 0; shift < 32; shift += 8)
    bytes += static_cast<char>((value >> shift) & 255U);
}

void append_little_endian(std::string& bytes, float value)
{
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  append_little_endian(bytes, bits);
}

std::string ply_of(const SkinState& skin, const std::vector<std::array<std::int32_t, 3>>& triangles, double time)
{
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment face frame, metres, time " + std::to_string(time) +
                      " s\nelement vertex " + std::to_string(skin.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z"
                      "\nproperty float nx\nproperty float ny\nproperty float nz"
                      "\nelement face " +
                      std::to_string(triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 24 * skin.vertices.size() + 13 * triangles.size());
  for (std::size_t v = 0; v < skin.vertices.size(); ++v)
  {
    for (const float coordinate : skin.vertices[v])
      append_little_endian(bytes, coordinate);
    for (const float coordinate : skin.normals[v])
      append_little_endian(bytes, coordinate);
  }
  for (const std::array<std::int32_t, 3>& triangle : triangles)
  {
    bytes += '\3';
    for (const std::int32_t corner : triangle)
      append_little_endian(bytes, static_cast<std::uint32_t>(corner));
  }
  return bytes;
}

}  // namespace

FrameFolder::FrameFolder(std::string path, const Model& model)
    : path_(std::move(path)), model_(model), table_("frame,time_s,landmark,x_m,y_m,z_m,forward_mm,left_mm,up_mm\n")
{
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (!std::filesystem::is_directory(path_))
    throw Error(path_ + ": cannot be made (" + error.message() + "); must be a folder to write frames in");
  const std::regex ours(R"((skin_[0-9]{4,}\.ply|landmarks\.csv|run\.json)(\.partial)?)");
  std::vector<std::filesystem::path> earlier;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours))
      earlier.push_back(entry.path());
  for (const std::filesystem::path& file : earlier)
    std::filesystem::remove(file, error);
}

void FrameFolder::write(const std::string& name, const std::string& bytes) const
{
  const std::string path = path_ + "/" + name;
  const std::string partial = path + ".partial";
  std::ofstream file(partial, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file)
    std::filesystem::rename(partial, path, error);
  if (!file || error)
  {
    std::filesystem::remove(partial, error);
    throw Error(path + ": cannot be written; must be in a folder that can be written, with space left");
  }
}

void FrameFolder::add(double time, const SkinState& skin)
{
  if (frames_ == 0)
    first_ = skin;
  char name[32];
  std::snprintf(name, sizeof name, "skin_%04d.ply", frames_);
  write(name, ply_of(skin, model_.skin.triangles, time));
  for (std::size_t l = 0; l < skin.landmarks.size(); ++l)
  {
    const std::array<float, 3>& now = skin.landmarks[l];
    const std::array<float, 3>& then = first_.landmarks[l];
    char row[256];
    std::snprintf(row, sizeof row, ",%.9g,%.9g,%.9g,%.6f,%.6f,%.6f\n", now[0], now[1], now[2], 1e3 * (now[0] - then[0]),
                  1e3 * (now[1] - then[1]), 1e3 * (now[2] - then[2]));
    table_ += std::to_string(frames_) + "," + std::to_string(time) + "," + model_.landmarks[l] + row;
  }
  ++frames_;
}

void FrameFolder::finish(const std::string& summary)
{
  write("landmarks.csv", table_);
  write("run.json", summary);
}

}  // namespace frontalis
