# cmake -DSOURCE=DIR -DOUTPUT=FILE -P commit.cmake: a .cpp that names the commit of the sources, for `--version`.
# Run at each build; the file is written anew only where the commit has changed. Without a repository: "unknown".
set(commit "unknown")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} describe --always --abbrev=10 --exclude=* --dirty=-changed WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${said})
  endif()
endif()
set(text "#include \"build.h\"\n\nnamespace servodx {\nconst std::string_view build_commit = \"${commit}\";\n}  // namespace servodx\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} written)
endif()
if(NOT text STREQUAL "${written}")
  file(WRITE ${OUTPUT} "${text}")
endif()
