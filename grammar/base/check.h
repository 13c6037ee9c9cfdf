// SPDX-License-Identifier: Apache-2.0
// Assertions about the program's own state; what people write is checked with diagnostics. A failed
// assertion throws std::logic_error, so that a run ends with its internal failure and says where.
//
//   PREHEND_CHECK(condition)   always
//   PREHEND_DCHECK(condition)  in builds with PREHEND_DEBUG_CHECKS (every preset but release,
//                              no-render and bench); for places that every frame passes
//
// Tested by tests/grammar/base/check_test.cc
#pragma once

#include <stdexcept>

#define PREHEND_TEXT_OF(words) #words
#define PREHEND_LINE_AS_TEXT(line) PREHEND_TEXT_OF(line)

#define PREHEND_CHECK(condition)                                                              \
  ((condition) ? void()                                                                       \
               : throw std::logic_error("internal error: " __FILE__ ":" PREHEND_LINE_AS_TEXT( \
                     __LINE__) ": not true: " #condition))

#ifdef PREHEND_DEBUG_CHECKS
#define PREHEND_DCHECK(condition) PREHEND_CHECK(condition)
#else
#define PREHEND_DCHECK(condition) (true ? void() : void(condition))
#endif
