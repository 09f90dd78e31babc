# Installs into a folder of its own, compiles every public header alone from there, builds the examples against it with
# find_package and runs them.
#   cmake -DBUILD=... -DSOURCE=... -DCOMPILER=... -P install_test.cmake
set(work ${BUILD}/install_test)
file(REMOVE_RECURSE ${work})
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "'${ARGN}' ended with ${code}\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
foreach(file bin/servodx share/man/man1/servodx.1 share/bash-completion/completions/servodx share/servodx/params/borello2009.csv)
  if(NOT EXISTS ${work}/prefix/${file})
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()
# Pictures that the pages show are beside them, and the tutorial's logs read where they lie.
set(pages ${work}/prefix/share/doc/servodx)
file(GLOB_RECURSE installed ${pages}/*.md)
set(shown 0)
foreach(page ${installed})
  file(READ ${page} text)
  string(REGEX MATCHALL "\\([^() :]*\\.(png|svg)\\)" pictures "${text}")  # targets of links
  cmake_path(GET page PARENT_PATH folder)
  foreach(picture ${pictures})
    string(REGEX REPLACE "[()]" "" picture "${picture}")
    if(NOT EXISTS ${folder}/${picture})
      message(FATAL_ERROR "${page} shows ${picture}, which is not installed")
    endif()
    math(EXPR shown "${shown} + 1")
  endforeach()
endforeach()
if(shown LESS 10)
  message(FATAL_ERROR "the installed pages show ${shown} pictures; the docs show more")
endif()
step(${CMAKE_COMMAND} -E chdir ${pages} ${work}/prefix/bin/servodx check-log data/tutorial/good_1.csv
     --rig data/tutorial/bench.toml)
if(NOT output MATCHES "nothing suspicious")
  message(FATAL_ERROR "the tutorial's check-log printed: ${output}")
endif()

# The installed program finds the models of `rig` from any folder; a call names them as the sources do.
set(away ${work}/away)
file(MAKE_DIRECTORY ${away})
function(rig program)
  step(${CMAKE_COMMAND} -E chdir ${away} ${program} rig --rig-model params/rigs/bench.toml --excitation mixed
       --duration 0.5 --rate 1000 --temperature 40 -o log.csv --quiet)
  if(NOT EXISTS ${away}/log.csv OR NOT EXISTS ${away}/log.truth.json)
    message(FATAL_ERROR "${program} rig wrote no log: ${output}")
  endif()
  file(REMOVE_RECURSE ${away})
  file(MAKE_DIRECTORY ${away})
endfunction()
rig(${work}/prefix/bin/servodx)
# The front door is all that is installed, under one root, and each header of it needs nothing but the standard library.
file(GLOB_RECURSE headers RELATIVE ${work}/prefix/include ${work}/prefix/include/*)
file(GLOB wanted RELATIVE ${SOURCE}/include ${SOURCE}/include/servodx/*.h)
if(NOT "${headers}" STREQUAL "${wanted}")
  message(FATAL_ERROR "installed headers: ${headers}\nthe front door: ${wanted}")
endif()
foreach(header ${headers})
  file(WRITE ${work}/alone.cpp "#include \"${header}\"\n")
  step(${COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I ${work}/prefix/include ${work}/alone.cpp)
endforeach()

# The page's program is one.
file(READ ${SOURCE}/docs/library.md page)
string(REGEX MATCH "```cpp\n([^`]*)```" fence "${page}")
file(WRITE ${work}/page.cpp "${CMAKE_MATCH_1}")
step(${COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I ${work}/prefix/include ${work}/page.cpp)

step(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${work}/build -G Ninja -DCMAKE_PREFIX_PATH=${work}/prefix
     -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
step(${CMAKE_COMMAND} --build ${work}/build)
step(${work}/build/simulate_log ${SOURCE}/data/healthy/h08_preflight_cold.csv
     ${work}/prefix/share/servodx/params/borello2009.csv ${SOURCE}/data/rig.toml)
if(NOT output MATCHES "spool_position: rms error")
  message(FATAL_ERROR "the example printed: ${output}")
endif()

set(tutorial ${SOURCE}/data/tutorial)
step(${work}/build/diagnose_log ${tutorial}/bench.toml ${work}/prefix/share/servodx/params/borello2009.csv
     ${tutorial}/suspect.csv ${tutorial}/good_1.csv ${tutorial}/good_2.csv ${tutorial}/good_5.csv ${tutorial}/good_6.csv ${tutorial}/good_7.csv)
if(NOT output MATCHES "suspect.csv: (healthy|fault|unknown)")
  message(FATAL_ERROR "the example printed: ${output}")
endif()

# Debian packages of the same: what they ask for, what they hold, and that the program in them runs.
find_program(DPKG_DEB dpkg-deb)
find_program(SHLIBDEPS dpkg-shlibdeps)
if(DPKG_DEB AND SHLIBDEPS)
  step(${CMAKE_CPACK_COMMAND} -G DEB -B ${work}/packages --config ${BUILD}/CPackConfig.cmake)
  function(deb name)  # its file, its Depends as a list, what is unpacked in ${work}/NAME
    file(GLOB file ${work}/packages/${name}_*.deb)
    list(LENGTH file count)
    if(NOT count EQUAL 1)
      message(FATAL_ERROR "packages called ${name}: '${file}'")
    endif()
    step(${DPKG_DEB} -f ${file} Depends)
    string(REGEX REPLACE " *[,|] *" ";" depends "${output}")
    foreach(wanted ${ARGN})
      if(NOT ";${depends}" MATCHES ";${wanted}")
        message(FATAL_ERROR "${name} depends on '${output}', and not on ${wanted}")
      endif()
    endforeach()
    step(${DPKG_DEB} -x ${file} ${work}/${name})
  endfunction()
  deb(servodx libc6 libfmt libmatio libgomp1 libnlopt libseccomp2 libssl libsqlite3)
  deb(libservodx-dev libceres-dev libeigen3-dev libfmt-dev libmatio libnlopt-cxx-dev libseccomp-dev libsqlitecpp-dev libssl-dev
      libtomlplusplus-dev nlohmann-json3-dev pkg-config)
  step(${work}/servodx/usr/bin/servodx list faults)
  rig(${work}/servodx/usr/bin/servodx)
  if(EXISTS ${BUILD}/python/servodx)
    deb(python3-servodx python3 python3-numpy python3-pandas libc6 libmatio libnlopt)
    # Nothing of the build is in reach.
    step(${CMAKE_COMMAND} -E chdir ${work} ${CMAKE_COMMAND} -E env
         PYTHONPATH=${work}/python3-servodx/usr/lib/python3/dist-packages /usr/bin/python3 -B -c
         "print((sx := __import__('servodx')).__file__, len(sx.Table.load('${SOURCE}/params/borello2009.csv')))")
    if(NOT output MATCHES "python3-servodx/usr/lib/python3/dist-packages/servodx/__init__.py 41")
      message(FATAL_ERROR "the package of Python says: ${output}")
    endif()
    foreach(file lib/python3/dist-packages/servodx/py.typed lib/python3/dist-packages/servodx/__init__.pyi
                 share/doc/python3-servodx/copyright)
      if(NOT EXISTS ${work}/python3-servodx/usr/${file})
        message(FATAL_ERROR "${file} is not in python3-servodx")
      endif()
    endforeach()
  endif()
  foreach(file servodx/usr/share/man/man1/servodx.1 servodx/usr/share/servodx/params/borello2009.csv
               servodx/usr/share/doc/servodx/docs/tutorial.md servodx/usr/share/doc/servodx/docs/pictures/fault.png
               servodx/usr/share/doc/servodx/docs/figures/model.svg
               servodx/usr/share/doc/servodx/data/tutorial/suspect.csv servodx/usr/share/doc/servodx/copyright
               libservodx-dev/usr/include/servodx/servodx.h)
    file(GLOB found ${work}/${file} ${work}/${file}.gz)
    if(NOT found)
      message(FATAL_ERROR "${file} is not in its package")
    endif()
  endforeach()
else()
  message("no dpkg-deb or dpkg-shlibdeps here: the Debian packages are not tested")
endif()
file(REMOVE_RECURSE ${work})
