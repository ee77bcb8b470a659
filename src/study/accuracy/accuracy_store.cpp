// Finished variants on disk. A file has a signature with the generation of the solver's motions, a hash of its content,
// and the content as bytes.

#include "study/accuracy/accuracy_run.hpp"

#include "frontalis/byte_archive.hpp"
#include "frontalis/scene/content_hash.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace frontalis
{
namespace
{

const std::string signature = fmt::format("frontalis accuracy 2, motions of generation {}\n", motion_generation);

template <class T>
void write(const std::string& path, T value)
{
  ByteArchive out;
  value.archive(out);
  const std::string content = out.bytes();
  write_text(path, signature + content_hash(content) + content);
}

// the content of a file; nothing if the file is missing or incomplete
std::optional<ByteArchive> read(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  const std::string whole{ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  const std::size_t begin = signature.size(), hash = 16;
  if (whole.compare(0, begin, signature) != 0 || whole.size() < begin + hash)
    return std::nullopt;
  std::string content = whole.substr(begin + hash);
  if (whole.compare(begin, hash, content_hash(content)) != 0)
    return std::nullopt;
  return ByteArchive(std::move(content));
}

template <class T>
std::optional<T> archived(const std::string& path)
{
  std::optional<ByteArchive> in = read(path);
  if (!in)
    return std::nullopt;
  T value;
  value.archive(*in);
  return in->ended() ? std::optional<T>(std::move(value)) : std::nullopt;
}

}  // namespace

void VariantMotion::archive(ByteArchive& archive)
{
  archive(fault);
  std::size_t count = phases.size();
  archive(count);
  phases.resize(count);
  for (SkinPhase& phase : phases)
    archive(phase.vertices)(phase.landmarks);
  archive(area)(steps)(energy)(residual)(voxels);
}

void VariantCost::archive(ByteArchive& archive) { archive(machine)(step)(spread)(processors)(skin)(memory)(build); }

void VariantCheckpoint::archive(ByteArchive& archive)
{
  motion.archive(archive);
  archive(slices)(solver);
}

VariantStore::VariantStore(std::string folder) : folder_(std::move(folder)) { make_folder(folder_); }

bool VariantStore::has_motion(const std::string& key) const { return std::filesystem::exists(path(key, "motion")); }

std::optional<VariantMotion> VariantStore::motion(const std::string& key) const
{
  return archived<VariantMotion>(path(key, "motion"));
}

std::optional<VariantCost> VariantStore::cost(const std::string& key) const
{
  return archived<VariantCost>(path(key, "cost"));
}

std::optional<VariantCheckpoint> VariantStore::checkpoint(const std::string& key) const
{
  return archived<VariantCheckpoint>(path(key, "checkpoint"));
}

void VariantStore::keep(const std::string& key, const VariantMotion& motion) const
{
  write(path(key, "motion"), motion);
  std::filesystem::remove(path(key, "checkpoint"));
}

void VariantStore::keep(const std::string& key, const VariantCost& cost) const { write(path(key, "cost"), cost); }

void VariantStore::keep(const std::string& key, const VariantCheckpoint& checkpoint) const
{
  write(path(key, "checkpoint"), checkpoint);
}

std::string VariantStore::path(const std::string& key, const char* extension) const
{
  return folder_ + "/" + key + "." + extension;
}

}  // namespace frontalis
