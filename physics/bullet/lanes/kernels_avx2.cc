// SPDX-License-Identifier: Apache-2.0
// For processors of x86-64 with AVX2. Fused multiplication, which would change bits, stays off.
// Tested by tests/physics/bullet/single_bodies_test.cc
#include <LinearMath/btScalar.h>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)

#include <immintrin.h>

#pragma GCC target("avx2")
#define PREHEND_AVX2

#include "physics/bullet/lanes/kernel_loops.h"

namespace prehend::physics {

const Kernels* const kAvx2Kernels = &PREHEND_WIDE::kKernels;

}  // namespace prehend::physics

#else

#include "physics/bullet/lanes/kernels.h"

namespace prehend::physics {

const Kernels* const kAvx2Kernels = nullptr;

}  // namespace prehend::physics

#endif
