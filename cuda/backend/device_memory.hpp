#pragma once

#include "frontalis/solver/backend.hpp"
#include "solver/stepping/array_list.hpp"

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{
namespace cuda
{

/// A failure of the device or of its runtime.
class DeviceFault : public Error
{
public:
  using Error::Error;
};

/// Throws DeviceFault with the failed operation and the message of the CUDA runtime, or BackendUnavailable if memory
/// ran out.
inline void require(cudaError_t status, const char* what)
{
  if (status == cudaSuccess)
    return;
  cudaGetLastError();  // or the next launch would report this error again
  const std::string text = std::string("backend cuda: ") + what + ": " + cudaGetErrorString(status);
  if (status == cudaErrorMemoryAllocation)
    throw BackendUnavailable(text);
  throw DeviceFault(text);
}

template <class T>
class DeviceArray
{
public:
  DeviceArray() = default;
  explicit DeviceArray(std::size_t size) : size_(size)
  {
    if (size_ > 0)
      require(cudaMalloc(reinterpret_cast<void**>(&data_), bytes()),
              ("allocating " + std::to_string(bytes()) + " bytes").c_str());
  }
  explicit DeviceArray(const std::vector<T>& host) : DeviceArray(host.size()) { upload(host.data(), size_); }
  ~DeviceArray() { cudaFree(data_); }
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept
  {
    swap(other);
    return *this;
  }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

  void upload(const T* host, std::size_t count)
  {
    if (count > 0)
      require(cudaMemcpy(data_, host, count * sizeof(T), cudaMemcpyHostToDevice), "copying to the device");
  }
  void download(std::vector<T>& host) const
  {
    host.resize(size_);
    if (size_ > 0)
      require(cudaMemcpy(host.data(), data_, bytes(), cudaMemcpyDeviceToHost), "copying from the device");
  }

  /// Sets all bytes to zero.
  void clear() const
  {
    if (size_ > 0)
      require(cudaMemset(data_, 0, bytes()), "clearing an array");
  }

private:
  void swap(DeviceArray& other)
  {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Lists an array that holds state of the motion.
template <class T>
void list_state(ArrayList& list, Effect effect, const std::string& what, const DeviceArray<T>& array)
{
  list.add(effect, what, array.bytes());
  list.add_state(array.data(), array.bytes());
}

/// Page-locked host memory, for copies that overlap with work of the device.
template <class T>
class PinnedArray
{
public:
  PinnedArray() = default;
  explicit PinnedArray(std::size_t size) : size_(size)
  {
    if (size_ > 0)
      require(cudaMallocHost(reinterpret_cast<void**>(&data_), size_ * sizeof(T)), "allocating page-locked memory");
  }
  ~PinnedArray() { cudaFreeHost(data_); }
  PinnedArray(PinnedArray&& other) noexcept { swap(other); }
  PinnedArray& operator=(PinnedArray&& other) noexcept
  {
    swap(other);
    return *this;
  }
  PinnedArray(const PinnedArray&) = delete;
  PinnedArray& operator=(const PinnedArray&) = delete;

  T* data() const { return data_; }
  std::size_t size() const { return size_; }

private:
  void swap(PinnedArray& other)
  {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace cuda
}  // namespace frontalis
