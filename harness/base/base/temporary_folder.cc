// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace prehend {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  // mkdtemp() puts other letters in the place of the six.
  std::string name = (fs::temp_directory_path(error) / "prehend-XXXXXX").string();
  if (!error && !mkdtemp(name.data())) error.assign(errno, std::generic_category());
  if (error)
    problem_ = "no folder for temporary files: " + error.message();
  else
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
}

}  // namespace prehend
