# SPDX-License-Identifier: Apache-2.0
# -DSOURCE=.. -DOUTPUT=..: a source file with the commit that the program is built from, for --version.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude * OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(commit)
  set(commit " (${commit})")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "extern const char* const kPrehendCommit;\nconst char* const kPrehendCommit = \"@commit@\";\n" @ONLY)
