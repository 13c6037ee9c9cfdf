// SPDX-License-Identifier: Apache-2.0
// A text file as ReadTextFile() reads it, a part at a time: it may be larger than memory. Tested by
// tests/harness/base/base/text_file_test.cc
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "harness/base/base/result.h"

namespace prehend {

class TextBlocks {
 public:
  TextBlocks(const std::string& path, std::uintmax_t most_bytes);
  /// About a megabyte of whole lines. "": the file is at its end, or there are problems.
  std::string Next();
  /// Of what was read so far.
  const grammar::Diagnostics& problems() const { return problems_; }

 private:
  void Refuse(std::string why);

  const std::string path_;
  std::ifstream stream_;
  std::string rest_;  ///< of what was read: a line without its end
  bool is_first_ = true;
  int lines_ = 0;  ///< before the next block
  grammar::Diagnostics problems_;
};

}  // namespace prehend
