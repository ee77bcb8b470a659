#pragma once

#include "cuda/backend/device_memory.hpp"

#include "frontalis/byte_archive.hpp"

namespace frontalis
{
namespace cuda
{

/// Writes or reads an array through host memory. The device must be idle.
template <class T>
void to_host(DeviceArray<T>& array, ByteArchive& archive)
{
  std::vector<T> host;
  if (!archive.reads())
    array.download(host);
  archive(host);
  if (archive.reads())
    array = DeviceArray<T>(host);
}

}  // namespace cuda
}  // namespace frontalis
