// SPDX-License-Identifier: Apache-2.0
// What a function returns that can fail on input: a value, or the diagnostics that explain why
// there is none, each with its place. Warnings are part of the value. Tested by
// tests/harness/base/base/text_file_test.cc
#pragma once

#include <tl/expected.hpp>
#include <utility>

#include "grammar/base/diagnostic.h"

namespace prehend {

template <class T>
using Result = tl::expected<T, grammar::Diagnostics>;

/// What PREHEND_TRY() returns: the error, or any result that holds it.
template <class E>
struct Failure {
  E error;

  operator E() && { return std::move(error); }  // NOLINT(google-explicit-constructor)
  template <class T>
  operator tl::expected<T, E>() && {  // NOLINT(google-explicit-constructor)
    return tl::unexpected(std::move(error));
  }
};

#define PREHEND_JOINED_(a, b) a##b
#define PREHEND_JOINED(a, b) PREHEND_JOINED_(a, b)
/// Declares a variable with the value of a result, or returns its error from this function:
/// PREHEND_TRY(const std::string text, ReadTextFile(path));
#define PREHEND_TRY(declaration, ...)                                               \
  auto PREHEND_JOINED(tried_, __LINE__) = __VA_ARGS__;                              \
  if (!PREHEND_JOINED(tried_, __LINE__))                                            \
    return ::prehend::Failure{std::move(PREHEND_JOINED(tried_, __LINE__).error())}; \
  declaration = *std::move(PREHEND_JOINED(tried_, __LINE__))

/// The diagnostics of a result, none if it is a value.
template <class T>
grammar::Diagnostics ErrorsOf(const Result<T>& result) {
  return result ? grammar::Diagnostics{} : result.error();
}

}  // namespace prehend
