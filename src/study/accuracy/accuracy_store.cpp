// Finished variants on disk. A file has a signature with the generation of the solver's motions, a hash of its content,
// and the content as bytes.

#include "study/accuracy/accuracy_run.hpp"

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

// the content of a file; nothing if the file is missing or incomplete
std::optional<ByteArchive> content_of(const std::string& path)
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

std::string VariantStore::path(const std::string& key, const char* extension) const
{
  return folder_ + "/" + key + "." + extension;
}

bool VariantStore::has_motion(const std::string& key) const
{
  return std::filesystem::exists(path(key, VariantMotion::extension));
}

template <class T>
std::optional<T> VariantStore::read(const std::string& key) const
{
  std::optional<ByteArchive> in = content_of(path(key, T::extension));
  T value;
  if (in)
    value.archive(*in);
  return in && in->ended() ? std::optional<T>(std::move(value)) : std::nullopt;
}

template <class T>
void VariantStore::keep(const std::string& key, T value) const
{
  ByteArchive out;
  value.archive(out);
  write_text(path(key, T::extension), signature + content_hash(out.bytes()) + out.bytes());
  if (std::is_same_v<T, VariantMotion>)
    std::filesystem::remove(path(key, VariantCheckpoint::extension));
}

template std::optional<VariantMotion> VariantStore::read(const std::string&) const;
template std::optional<VariantCost> VariantStore::read(const std::string&) const;
template std::optional<VariantCheckpoint> VariantStore::read(const std::string&) const;
template void VariantStore::keep(const std::string&, VariantMotion) const;
template void VariantStore::keep(const std::string&, VariantCost) const;
template void VariantStore::keep(const std::string&, VariantCheckpoint) const;

}  // namespace frontalis
