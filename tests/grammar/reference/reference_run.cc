// SPDX-License-Identifier: Apache-2.0
// reference_run [TICKS [SEED]]: the engine against the reference on random grammars. Prints "N
// ticks, M grammars, 0 mismatches"; exit code 1 with the first mismatch when there is one. See
// docs/grammar-language.md.
#include <cstdio>
#include <cstdlib>

#include "tests/grammar/reference/reference_trial.h"

int main(int argc, char** argv) {
  const long long ticks = argc > 1 ? std::atoll(argv[1]) : 10'000'000;
  const unsigned long long seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const prehend::grammar::testing::TrialResult result =
      prehend::grammar::testing::TryRandomGrammars(seed, ticks);
  std::printf("%s\n", result.Text().c_str());
  if (result.mismatches == 0) return 0;
  std::printf("the first one: %s\n", result.first.c_str());
  return 1;
}
