# `cmake --install`: the program, its manual page and completions, the tables, the pages with their pictures and the logs of
# the tutorial, and the library with its headers for
# find_package(servodx): the front door alone, include/servodx. The Python package goes where Debian's Python looks. `cpack`
# makes Debian packages of the same: servodx, libservodx-dev and python3-servodx.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS servodx RUNTIME COMPONENT program)
install(DIRECTORY params DESTINATION ${CMAKE_INSTALL_DATADIR}/servodx COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES third_party/uplot/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright.uplot COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program FILES_MATCHING
        PATTERN "*.md" PATTERN "*.schema.json" PATTERN "*.png" PATTERN "*.svg")
install(DIRECTORY data/tutorial DESTINATION ${CMAKE_INSTALL_DOCDIR}/data COMPONENT program)  # as the page calls them

# Manual and completions come from the program itself, made with it: the target servodx is enough to install.
set(manual ${CMAKE_BINARY_DIR}/manual)
add_custom_command(
  TARGET servodx POST_BUILD
  BYPRODUCTS ${manual}/servodx.1 ${manual}/servodx.bash ${manual}/_servodx ${manual}/servodx.fish
  COMMAND ${CMAKE_COMMAND} -E make_directory ${manual}
  COMMAND servodx man > ${manual}/servodx.1
  COMMAND servodx completion bash > ${manual}/servodx.bash
  COMMAND servodx completion zsh > ${manual}/_servodx
  COMMAND servodx completion fish > ${manual}/servodx.fish
  VERBATIM)
install(FILES ${manual}/servodx.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${manual}/servodx.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME servodx
        COMPONENT program)
install(FILES ${manual}/_servodx DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${manual}/servodx.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)

# One target for users, servodx::servodx, over the folders' libraries.
get_property(folders GLOBAL PROPERTY servodx_libraries)
add_library(servodx_api INTERFACE)
target_link_libraries(servodx_api INTERFACE ${folders})
target_compile_features(servodx_api INTERFACE cxx_std_20)
set_target_properties(servodx_api PROPERTIES EXPORT_NAME servodx)
install(TARGETS servodx_api ${folders} EXPORT servodx-targets ARCHIVE COMPONENT development)
install(EXPORT servodx-targets NAMESPACE servodx:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/servodx
        COMPONENT development)
install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
configure_file(cmake/servodx-config.cmake ${CMAKE_BINARY_DIR}/servodx-config.cmake COPYONLY)
set(compatible SameMajorVersion)  # docs/releasing.md
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatible SameMinorVersion)
endif()
write_basic_package_version_file(${CMAKE_BINARY_DIR}/servodx-config-version.cmake COMPATIBILITY ${compatible})
install(FILES ${CMAKE_BINARY_DIR}/servodx-config.cmake ${CMAKE_BINARY_DIR}/servodx-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/servodx COMPONENT development)

# For a wheel the package is its root (pyproject.toml).
if(TARGET servodx_python)
  set(python_home lib/python3/dist-packages/servodx)
  if(SKBUILD)
    set(python_home servodx)
  endif()
  install(TARGETS servodx_python LIBRARY DESTINATION ${python_home} COMPONENT python)
  install(FILES ${python_files} DESTINATION ${python_home} COMPONENT python)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/python3-servodx RENAME copyright COMPONENT python)
endif()

# What is installed, and no test: scripts/package builds this.
add_custom_target(servodx_installed)
add_dependencies(servodx_installed servodx ${folders})
if(TARGET servodx_python)
  add_dependencies(servodx_installed servodx_python)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR servodx)
set(CPACK_PACKAGE_CONTACT "servodx maintainers <servodx@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "fault diagnosis of electrohydraulic servovalves from rig logs")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program development)
if(TARGET servodx_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME servodx)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${matio_package}")  # loaded at need, so dpkg-shlibdeps does not see it
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS chromium)  # --pdf
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libservodx-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libceres-dev, libnlopt-cxx-dev, libeigen3-dev, libfmt-dev, libtomlplusplus-dev, nlohmann-json3-dev, libssl-dev, libseccomp-dev, ${matio_package}, libsqlitecpp-dev, libsqlite3-dev, pkg-config, g++")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-servodx)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
math(EXPR next_python "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "${matio_package}, python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy, python3-pandas")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib, python3-scipy, servodx")
include(CPack)
