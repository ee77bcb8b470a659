#include "cli/frame_folder.hpp"

#include "cli/reactions.hpp"

#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <regex>
#include <utility>

namespace frontalis
{
namespace
{

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the bytes of numbers are written as they are in memory");

template <class T>
void append(std::string& bytes, const T& numbers)
{
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof numbers[0]);
}

std::string ply_of(const SkinState& skin, const std::vector<std::array<std::int32_t, 3>>& triangles, double time)
{
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment face frame, metres, time {:.6f} s\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      time, skin.vertices.size(), triangles.size());
  bytes.reserve(bytes.size() + 24 * skin.vertices.size() + 13 * triangles.size());
  for (std::size_t v = 0; v < skin.vertices.size(); ++v)
  {
    append(bytes, skin.vertices[v]);
    append(bytes, skin.normals[v]);
  }
  for (const std::array<std::int32_t, 3>& triangle : triangles)
  {
    bytes += '\3';
    append(bytes, triangle);
  }
  return bytes;
}

}  // namespace

FrameFolder::FrameFolder(std::string path, const Model& model)
    : path_(std::move(path)), model_(model), table_("frame,time_s,landmark,x_m,y_m,z_m,forward_mm,left_mm,up_mm\n")
{
  make_folder(path_);
  const std::regex ours(R"((skin_[0-9]{4,}\.ply|landmarks\.csv|reactions\.csv|run\.json)(\.partial)?)");
  std::vector<std::filesystem::path> earlier;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours))
      earlier.push_back(entry.path());
  for (const std::filesystem::path& file : earlier)
    std::filesystem::remove(file);
}

void FrameFolder::add(double time, const SkinState& skin, const std::vector<Reaction>& reactions)
{
  if (frames_ == 0)
    first_ = skin;
  write_text(fmt::format("{}/skin_{:04}.ply", path_, frames_), ply_of(skin, model_.skin.triangles, time));
  for (std::size_t l = 0; l < skin.landmarks.size(); ++l)
  {
    const std::array<float, 3>& now = skin.landmarks[l];
    const std::array<float, 3>& then = first_.landmarks[l];
    table_ += fmt::format("{},{:.6f},{},{:.9g},{:.9g},{:.9g},{:.6f},{:.6f},{:.6f}\n", frames_, time,
                          model_.landmarks[l], now[0], now[1], now[2], 1e3 * (now[0] - then[0]),
                          1e3 * (now[1] - then[1]), 1e3 * (now[2] - then[2]));
  }
  reactions_ += reaction_rows(model_, frames_, time, reactions);
  ++frames_;
}

void FrameFolder::finish(const std::string& summary)
{
  write_text(path_ + "/landmarks.csv", table_);
  if (!model_.contacts.empty())
    write_text(path_ + "/reactions.csv", reaction_heading + reactions_);
  write_text(path_ + "/run.json", summary);
}

}  // namespace frontalis
