// SPDX-License-Identifier: Apache-2.0
// For any processor. Tested by tests/physics/bullet/single_bodies_test.cc
#include "physics/bullet/lanes/kernel_loops.h"
#include "physics/bullet/lanes/kernels.h"

namespace prehend::physics {

const Kernels kPlainKernels = PREHEND_WIDE::kKernels;

const Kernels& BestKernels() {
#ifdef __x86_64__
  static const bool wide = kAvx2Kernels && __builtin_cpu_supports("avx2");
#else
  constexpr bool wide = false;
#endif
  return wide ? *kAvx2Kernels : kPlainKernels;
}

}  // namespace prehend::physics
