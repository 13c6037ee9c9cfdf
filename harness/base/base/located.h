// SPDX-License-Identifier: Apache-2.0
// Values that know where they were written. Tested by tests/harness/base/yaml/located_yaml_test.cc
#pragma once

#include "grammar/base/diagnostic.h"

namespace prehend {

/// A place in one of a document's sources.
struct Where {
  int source = 0;  ///< index into YamlDocument::sources
  grammar::Place place;
};

/// A value that knows where it was written.
template <class T>
struct Located {
  T value{};
  Where where;
};

}  // namespace prehend
