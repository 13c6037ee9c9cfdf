// SPDX-License-Identifier: Apache-2.0
// Assertions, as in grammar/base/check.h, which this room does not see; word for word the same, so
// that a file may include both. Tested by tests/grammar/base/check_test.cc
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
