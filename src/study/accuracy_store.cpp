// finished variants on disk: lines of numbers by name, then arrays, then the hash of all

#include "accuracy_run.hpp"

#include "frontalis/error.hpp"
#include "frontalis/scene/content_hash.hpp"
#include "frontalis/study/table.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace frontalis
{
namespace
{

constexpr const char* signature = "frontalis accuracy 1\n";

template <class T>
void put(std::string& out, const T& value)
{
  static_assert(std::is_trivially_copyable_v<T>);
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void put(std::string& out, const std::string& text)
{
  put(out, text.size());
  out += text;
}

template <class T>
void put(std::string& out, const std::vector<T>& values)
{
  put(out, values.size());
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// Takes back what was put, in the same order.
class Bytes
{
public:
  explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class T>
  void take(T& value)
  {
    copy(&value, sizeof(T));
  }
  void take(std::string& text)
  {
    text.resize(length(1));
    copy(text.data(), text.size());
  }
  template <class T>
  void take(std::vector<T>& values)
  {
    values.resize(length(sizeof(T)));
    copy(values.data(), values.size() * sizeof(T));
  }

private:
  std::size_t length(std::size_t size)
  {
    std::size_t count = 0;
    take(count);
    if (count > (bytes_.size() - at_) / size)
      throw Error("truncated");
    return count;
  }
  void copy(void* to, std::size_t size)
  {
    if (size > bytes_.size() - at_)
      throw Error("truncated");
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  std::string bytes_;
  std::size_t at_ = 0;
};

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
std::optional<Bytes> read(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  const std::string whole{ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  const std::size_t begin = std::strlen(signature), hash = 16;
  if (whole.compare(0, begin, signature) != 0 || whole.size() < begin + hash)
    return std::nullopt;
  std::string content = whole.substr(begin + hash);
  if (whole.compare(begin, hash, content_hash(content)) != 0)
    return std::nullopt;
  return Bytes(std::move(content));
}

}  // namespace

VariantStore::VariantStore(std::string folder) : folder_(std::move(folder))
{
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed)
    throw Error(folder_ + ": cannot be made: " + failed.message());
}

void VariantStore::keep(const std::string& key, const VariantMotion& motion) const
{
  std::string out;
  put(out, motion.fault);
  put(out, motion.phases.size());
  for (const SkinPhase& phase : motion.phases)
  {
    put(out, phase.vertices);
    put(out, phase.landmarks);
  }
  put(out, motion.area);
  for (const double value : { motion.steps, motion.energy, motion.residual, motion.voxels })
    put(out, value);
  write(folder_ + "/" + key + ".motion", out);
}

bool VariantStore::has_motion(const std::string& key) const
{
  return std::filesystem::exists(folder_ + "/" + key + ".motion");
}

std::optional<VariantMotion> VariantStore::motion(const std::string& key) const
{
  std::optional<Bytes> in = read(folder_ + "/" + key + ".motion");
  if (!in)
    return std::nullopt;
  VariantMotion motion;
  in->take(motion.fault);
  std::size_t phases = 0;
  in->take(phases);
  for (; phases > 0; --phases)
  {
    motion.phases.emplace_back();
    in->take(motion.phases.back().vertices);
    in->take(motion.phases.back().landmarks);
  }
  in->take(motion.area);
  for (double* const value : { &motion.steps, &motion.energy, &motion.residual, &motion.voxels })
    in->take(*value);
  return motion;
}

void VariantStore::keep(const std::string& key, const VariantCost& cost) const
{
  std::string out;
  put(out, cost.machine);
  for (const double value : { cost.step, cost.spread, cost.processors, cost.skin, cost.memory, cost.build })
    put(out, value);
  write(folder_ + "/" + key + ".cost", out);
}

std::optional<VariantCost> VariantStore::cost(const std::string& key) const
{
  std::optional<Bytes> in = read(folder_ + "/" + key + ".cost");
  if (!in)
    return std::nullopt;
  VariantCost cost;
  in->take(cost.machine);
  for (double* const value : { &cost.step, &cost.spread, &cost.processors, &cost.skin, &cost.memory, &cost.build })
    in->take(*value);
  return cost;
}

}  // namespace frontalis
