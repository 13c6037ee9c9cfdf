# SPDX-License-Identifier: Apache-2.0
# Lists what ctest runs of a test binary, once it is linked: each suite in one process, which makes what its tests share (an
# episode, a folder of knowledge) once; those of LONG each by itself, with the label long. FIRST: the names of those that
# take longest, which ctest begins with, so that no core waits for them at the end.
file(WRITE ${OUTPUT} "")

# add(NAME FILTER [PROPERTY VALUE]..)
function(add name filter)
  list(FIND FIRST ${name} place)
  if(NOT place EQUAL -1)
    math(EXPR cost "100 - ${place}")
    list(APPEND ARGN COST ${cost})
  endif()
  list(JOIN ARGN " " properties)
  file(APPEND ${OUTPUT} "add_test([=[${name}]=] [=[${BINARY}]=] [=[--gtest_filter=${filter}]=])\n"
    "set_tests_properties([=[${name}]=] PROPERTIES WORKING_DIRECTORY [=[${FOLDER}]=] ${properties})\n")
endfunction()

# list_tests(FILTER): sets `suites`, and `tests`, each with its suite.
macro(list_tests filter)
  execute_process(COMMAND ${BINARY} --gtest_list_tests --gtest_filter=${filter} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "\n *[A-Za-z0-9_/]+\\.?" lines "\n${lines}")
  set(suites)
  set(tests)
  foreach(line ${lines})
    string(STRIP "${line}" word)
    if(line MATCHES "^\n ")
      list(APPEND tests ${suite}${word})
    elseif(word MATCHES "\\.$")
      set(suite ${word})
      list(APPEND suites ${suite})
    endif()
  endforeach()
endmacro()

list_tests("-${LONG}")
foreach(suite ${suites})
  string(REGEX REPLACE "\\.$" "" name ${suite})
  add(${ROOM}.${name} "${suite}*-${LONG}")
endforeach()
list_tests("${LONG}")
foreach(test ${tests})
  add(${ROOM}.${test} "${test}" LABELS long)
endforeach()
