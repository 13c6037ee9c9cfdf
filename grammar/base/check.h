// SPDX-License-Identifier: Apache-2.0
// Assertions about the program's own state; what people write is checked with diagnostics. A failed
// assertion throws std::logic_error, so that a run ends with its internal failure and says where.
//
//   PREHEND_CHECK(condition)   always
//   PREHEND_DCHECK(condition)  in builds with PREHEND_DEBUG_CHECKS (the presets dev, asan-ubsan and
//                              fuzz); for places that every frame passes
//
// Tested by tests/grammar/base/check_test.cc
#pragma once

#include <stdexcept>
#include <string>

namespace prehend::grammar {

[[noreturn]] inline void FailCheck(const char* file, int line, const char* condition) {
  throw std::logic_error(std::string("internal error: ") + file + ":" + std::to_string(line) +
                         ": not true: " + condition);
}

}  // namespace prehend::grammar

#define PREHEND_CHECK(condition) \
  ((condition) ? void() : ::prehend::grammar::FailCheck(__FILE__, __LINE__, #condition))

#ifdef PREHEND_DEBUG_CHECKS
#define PREHEND_DCHECK(condition) PREHEND_CHECK(condition)
#else
#define PREHEND_DCHECK(condition) (true ? void() : void(condition))
#endif
