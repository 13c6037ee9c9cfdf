// SPDX-License-Identifier: Apache-2.0
// A law in the words of the language.
#include "grammar/program/law.h"

namespace prehend::grammar {

std::string Law::Head() const {
  std::string text = "law " + name + "(";
  for (const Role& role : roles)
    text += (&role == &roles.front() ? "" : ", ") + role.name + ": " + role.class_name;
  return text + ")";
}

}  // namespace prehend::grammar
