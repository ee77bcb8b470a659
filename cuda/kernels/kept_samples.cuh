#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

/// Hides the address of a rarely called function from the compiler. The compiler would otherwise allocate the registers
/// of the function and its caller together and spill some of them.
template <class Function>
__device__ __forceinline__ Function* aside(Function* function)
{
  auto address = reinterpret_cast<std::uint64_t>(function);
  asm volatile("" : "+l"(address));
  return reinterpret_cast<Function*>(address);
}

/// The samples of a field around a node or a point. Each node or point has its own copy, which the threads of a warp
/// load together (see sample_words). In most steps a node or point stays in its cell, so that its copy remains valid.
struct KeptSamples
{
  float4* words;
  std::uint32_t count, index;  ///< number of all copies, and index of this one

  /// The n-th of the 28 numbers in the copy.
  __device__ __forceinline__ float& number(int n) const
  {
    return reinterpret_cast<float*>(words + n / 4 * count + index)[n % 4];
  }

  /// Copies the samples of a cell, minus a level. `code`: the cell relative to `home` (middle_cell). Returns false, and
  /// copies nothing, if the cell has no samples.
  __device__ __forceinline__ bool copy(const physics::DistanceField& field, const std::int32_t (&home)[3],
                                       std::uint32_t code, float level) const
  {
    std::int32_t cell[3];
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = home[axis] + static_cast<std::int32_t>(code >> 10 * axis & 1023u) - middle_cell;
    const float* const first = field.around(cell);
    if (first == nullptr)
      return false;
    const physics::FieldSamples samples = physics::gather(first);
    for (int n = 0; n < 27; ++n)
      number(n) = samples.value[n] - level;
    return true;
  }

  /// Finds the field at `offset` from the cell of the rest position. `kept`: code of the cell whose samples are in the
  /// copy; enter(code) replaces them by those of another cell. Returns false if no samples are stored there.
  template <class Enter>
  __device__ __forceinline__ bool value_at(float inverse_spacing, const physics::Vec3<float>& offset,
                                           std::uint32_t kept, physics::FieldValue<float>& value,
                                           const Enter& enter) const
  {
    std::int32_t cell[3] = { middle_cell, middle_cell, middle_cell };
    const physics::Vec3<float> place = physics::enter_cell(inverse_spacing, offset, cell);
    if (((cell[0] | cell[1] | cell[2]) & ~1023) != 0)
      return false;
    const std::uint32_t code = cell[0] | cell[1] << 10 | cell[2] << 20;
    if (code != kept && !enter(code))
      return false;
    physics::FieldSamples samples;
    FRONTALIS_UNROLL
    for (int w = 0; w < sample_words; ++w)
    {
      const float4 word = words[w * count + index];
      const float of[4] = { word.x, word.y, word.z, word.w };
      FRONTALIS_UNROLL
      for (int n = 4 * w; n < 4 * w + 4 && n < 27; ++n)
        samples.value[n] = of[n - 4 * w];
    }
    value = physics::spline(samples, inverse_spacing, place);
    return true;
  }
};

}  // namespace cuda
}  // namespace frontalis
