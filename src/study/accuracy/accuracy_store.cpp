// finished variants on disk: signature, which tells the solver's generation, hash of the rest, the rest as bytes

#include "study/accuracy/accuracy_run.hpp"

#include "frontalis/byte_archive.hpp"
#include "frontalis/scene/content_hash.hpp"
#include "frontalis/study/table.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace frontalis
{
namespace
{

const std::string signature = "frontalis accuracy 2, motions of generation " + std::to_string(motion_generation) + "\n";

void write(const std::string& path, const std::string& content)
{
  const std::string next = path + ".part";
  write_text(next, signature + content_hash(content) + content);
  std::error_code failed;
  std::filesystem::rename(next, path, failed);
  if (failed)
    throw Error(path + ": cannot be written: " + failed.message());
}

// nothing where there is no whole file
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

VariantStore::VariantStore(std::string folder) : folder_(std::move(folder))
{
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed)
    throw Error(folder_ + ": cannot be made: " + failed.message());
}

void VariantStore::keep(const std::string& key, const VariantMotion& motion) const
{
  ByteArchive out;
  VariantMotion(motion).archive(out);
  write(folder_ + "/" + key + ".motion", out.bytes());
  std::filesystem::remove(checkpoint_path(key));
}

bool VariantStore::has_motion(const std::string& key) const
{
  return std::filesystem::exists(folder_ + "/" + key + ".motion");
}

std::optional<VariantMotion> VariantStore::motion(const std::string& key) const
{
  return archived<VariantMotion>(folder_ + "/" + key + ".motion");
}

void VariantStore::keep(const std::string& key, const VariantCost& cost) const
{
  ByteArchive out;
  VariantCost(cost).archive(out);
  write(folder_ + "/" + key + ".cost", out.bytes());
}

std::optional<VariantCost> VariantStore::cost(const std::string& key) const
{
  return archived<VariantCost>(folder_ + "/" + key + ".cost");
}

void VariantStore::keep(const std::string& key, const VariantCheckpoint& checkpoint) const
{
  ByteArchive out;
  VariantCheckpoint(checkpoint).archive(out);
  write(checkpoint_path(key), out.bytes());
}

std::optional<VariantCheckpoint> VariantStore::checkpoint(const std::string& key) const
{
  return archived<VariantCheckpoint>(checkpoint_path(key));
}

std::string VariantStore::checkpoint_path(const std::string& key) const { return folder_ + "/" + key + ".checkpoint"; }

}  // namespace frontalis
