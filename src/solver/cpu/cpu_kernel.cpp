#include "solver/cpu/cpu_kernel.hpp"

#include "frontalis/error.hpp"

#include <cstdlib>
#include <string>

// The solver with mutations has the baseline's kernels alone.
#if defined(__x86_64__) && !defined(FRONTALIS_MUTATIONS)
#define FRONTALIS_WIDE_KERNELS
#endif

namespace frontalis
{

CpuKernelChoice cpu_kernel_baseline(const char* name);
#if defined(FRONTALIS_WIDE_KERNELS)
CpuKernelChoice cpu_kernel_avx2(const char* name);
CpuKernelChoice cpu_kernel_avx512(const char* name);
#endif

CpuKernelChoice choose_cpu_kernel()
{
  const char* variable = std::getenv("FRONTALIS_INSTRUCTION_SET");
  const std::string wanted = variable == nullptr ? "" : variable;
#if defined(FRONTALIS_WIDE_KERNELS)
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd");
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx512 && (wanted.empty() || wanted == "avx512"))
    return cpu_kernel_avx512("AVX-512");
  if (avx2 && (wanted.empty() || wanted == "avx2"))
    return cpu_kernel_avx2("AVX2");
#endif
  if (wanted.empty() || wanted == "baseline")
    return cpu_kernel_baseline("baseline");
  throw Error("FRONTALIS_INSTRUCTION_SET is \"" + wanted +
              "\": this machine has none such; known are baseline, avx2, avx512");
}

}  // namespace frontalis
