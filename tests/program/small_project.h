// SPDX-License-Identifier: Apache-2.0
// A project folder of its own for each test, with the libraries of grammars and hands, and one
// scenario that nothing moves in.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/program/program.h"

namespace prehend::house {

extern const char* const kCartonRests;

class SmallProject : public testing::Test {
 protected:
  SmallProject();
  ~SmallProject() override;

  std::filesystem::path Scenario(const std::string& id = "rest/carton_rests") const;
  std::filesystem::path Golden(const std::string& id = "rest/carton_rests") const;
  std::filesystem::path Pending() const;

  /// The scenario with each `from` replaced by `to`, under another name; `id` is skill/name.
  void WriteVariant(const std::string& id, const std::string& from, const std::string& to) const;

  /// `prehend ARGUMENTS`, which are separated by blanks.
  Said Do(const std::string& arguments, const std::string& ci = "") const;

  void Accept(const std::string& id = "carton_rests") const;

  const std::filesystem::path root_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace prehend::house
