# The package `servodx` of Python: the module of python/*.cpp beside the files of python/servodx, in the build's folder
# python/. Where they are installed, and the Debian package python3-servodx, stand in install.cmake.
file(GLOB python_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/python/*.cpp)
file(GLOB python_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/python/servodx/*.py ${CMAKE_SOURCE_DIR}/python/servodx/*.pyi
     ${CMAKE_SOURCE_DIR}/python/servodx/py.typed)
pybind11_add_module(servodx_python MODULE NO_EXTRAS ${python_sources})
target_link_libraries(servodx_python PRIVATE servodx_door OpenMP::OpenMP_CXX)
target_compile_definitions(servodx_python PRIVATE SERVODX_VERSION="${PROJECT_VERSION}")
target_compile_options(servodx_python PRIVATE ${words_only})
# pybind11's headers cost more than what is made of them: some files share one reading.
set_target_properties(servodx_python PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
set(python_packages ${CMAKE_BINARY_DIR}/python)
set_target_properties(servodx_python PROPERTIES OUTPUT_NAME _servodx
                      LIBRARY_OUTPUT_DIRECTORY ${python_packages}/servodx)
add_custom_target(servodx_python_files ALL
                  COMMAND ${CMAKE_COMMAND} -E make_directory ${python_packages}/servodx
                  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${python_files} ${python_packages}/servodx VERBATIM)
add_dependencies(servodx_python servodx_python_files)

if(NOT SERVODX_SANITIZE)  # an interpreter without the sanitizers cannot load what has them
  # tests/python/NAME_test.py is the test python.NAME.
  file(GLOB python_tests CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/python/*_test.py)
  foreach(test ${python_tests})
    cmake_path(GET test STEM name)
    string(REPLACE _test "" name ${name})
    add_test(NAME python.${name} COMMAND ${Python_EXECUTABLE} -B ${test} ${python_packages} ${CMAKE_SOURCE_DIR}
                                         $<TARGET_FILE:servodx>)
    set_tests_properties(python.${name} PROPERTIES SKIP_RETURN_CODE 77)
    if(name IN_LIST nightly_python)
      set_tests_properties(python.${name} PROPERTIES LABELS nightly)
    endif()
  endforeach()
endif()
