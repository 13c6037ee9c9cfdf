# SPDX-License-Identifier: Apache-2.0
# Makes replay.txt, the script of the 3D replay (bundle.mjs), in OUTPUT's folder: one try, within a time limit. Without
# npm or its registry the build goes on: replay.txt is empty, and why_not.txt says why.
#   cmake -DSOURCE=harness/suite/report/replay -DFOLDER=BUILD/replay -P make_bundle.cmake
file(MAKE_DIRECTORY ${FOLDER})
file(REMOVE ${FOLDER}/replay.txt ${FOLDER}/why_not.txt)

function(leave_out reason)
  file(WRITE ${FOLDER}/replay.txt "")
  file(WRITE ${FOLDER}/why_not.txt "${reason}")
  message("note: the report page will have no 3D replay: ${reason}. To try again, delete ${FOLDER} and build.")
endfunction()

find_program(NODE NAMES node nodejs)
find_program(NPM npm)
if(NOT NODE OR NOT NPM)
  leave_out("npm was not found when the program was built (Debian's package npm)")
  return()
endif()
foreach(name package.json package-lock.json bundle.mjs replay.js)
  file(COPY_FILE ${SOURCE}/${name} ${FOLDER}/${name})
endforeach()
execute_process(
  COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=0 --fetch-timeout=20000
  WORKING_DIRECTORY ${FOLDER} TIMEOUT 60 RESULT_VARIABLE failed OUTPUT_FILE npm.log ERROR_FILE npm.log)
if(NOT failed STREQUAL "0")
  leave_out("three.js could not be had from npm when the program was built")
  return()
endif()
execute_process(COMMAND ${NODE} bundle.mjs replay.txt
  WORKING_DIRECTORY ${FOLDER} TIMEOUT 60 RESULT_VARIABLE failed OUTPUT_FILE bundle.log ERROR_FILE bundle.log)
if(NOT failed STREQUAL "0" OR NOT EXISTS ${FOLDER}/replay.txt)
  leave_out("esbuild failed when the program was built, see bundle.log")
endif()
