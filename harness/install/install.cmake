# SPDX-License-Identifier: Apache-2.0
# `cmake --install build/package`, and the Debian package (`cpack`): the program with what it reads, the C++ libraries, the
# Python module. docs/install.md says what is where.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(here ${CMAKE_CURRENT_LIST_DIR})
set(share ${CMAKE_INSTALL_DATADIR}/prehend)
set(cmake_files ${CMAKE_INSTALL_LIBDIR}/cmake/prehend)

install(TARGETS prehend RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(folder grammar/library physics/library scenarios golden docs)
  cmake_path(GET folder PARENT_PATH parent)
  install(DIRECTORY ${folder} DESTINATION ${share}/${parent})
endforeach()
file(GLOB knowledge harness/exchange/knowledge/*.pl harness/exchange/knowledge/*.ttl)
install(FILES ${knowledge} DESTINATION ${share}/harness/exchange/knowledge)
install(FILES ${PROJECT_BINARY_DIR}/manual/prehend.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${PROJECT_BINARY_DIR}/manual/prehend.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME prehend)
install(FILES ${PROJECT_BINARY_DIR}/manual/_prehend DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
configure_file(${here}/changelog.in ${PROJECT_BINARY_DIR}/changelog @ONLY)
execute_process(COMMAND gzip -9nkf ${PROJECT_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${here}/copyright ${PROJECT_BINARY_DIR}/changelog.gz CITATION.cff README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/prehend)

# prehend::grammar: grammars are compiled and watched. Its headers include the standard library and Eigen only.
target_include_directories(prehend_grammar INTERFACE
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/prehend>)
target_compile_features(prehend_grammar INTERFACE cxx_std_20)
target_compile_definitions(prehend_grammar INTERFACE $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=16>)
set_target_properties(prehend_grammar PROPERTIES EXPORT_NAME grammar)
set_target_properties(prehend_math PROPERTIES EXPORT_NAME math)
install(TARGETS prehend_grammar prehend_math EXPORT prehend ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
file(GLOB interface RELATIVE ${PROJECT_SOURCE_DIR} grammar/*.h grammar/base/*.h grammar/program/*.h)
list(REMOVE_ITEM interface grammar/watch_drawing.h)  # drawings are tests of grammars, for the program
foreach(header ${interface} grammar/compile/compile.h)
  cmake_path(GET header PARENT_PATH parent)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/prehend/${parent})
endforeach()
configure_file(${here}/version.h.in ${PROJECT_BINARY_DIR}/version.h @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/prehend)
configure_package_config_file(${here}/prehend-config.cmake.in ${PROJECT_BINARY_DIR}/prehend-config.cmake INSTALL_DESTINATION ${cmake_files})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/prehend-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/prehend-config.cmake ${PROJECT_BINARY_DIR}/prehend-config-version.cmake DESTINATION ${cmake_files})

# prehend::episode. In the tree its headers are those of a room.
install(TARGETS prehend_shared EXPORT prehend LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(header episode frames study)
  file(READ ${PROJECT_SOURCE_DIR}/harness/library/library/${header}.h text)
  string(REPLACE "harness/library/library/" "prehend/" text "${text}")
  file(WRITE ${PROJECT_BINARY_DIR}/include/${header}.h "${text}")
  install(FILES ${PROJECT_BINARY_DIR}/include/${header}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/prehend)
endforeach()
install(EXPORT prehend NAMESPACE prehend:: DESTINATION ${cmake_files} FILE prehend-targets.cmake)

# The Debian package: it depends on what it links, and recommends what it starts.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME prehend)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The prehend developers <developers@prehend.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "test harness and benchmark for grammars of manipulation activities")
set(CPACK_PACKAGE_DESCRIPTION "Synthetic hands and bodies act in a simulated world, a grammar segments what
 they do into timed events, and the events are compared with accepted
 timelines. Recordings of people and robots are segmented, scored and pictured
 as well. With a C++ library and a Python module.")
set(CPACK_PACKAGE_HOMEPAGE_URL "")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${here}/triggers)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6, fonts-dejavu-core, python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-pandas")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "swi-prolog-nox, librsvg2-bin, libeigen3-dev, libsleef-dev")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
