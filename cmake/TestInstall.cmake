# SPDX-FileCopyrightText: The Vantage authors
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.25)
# Installs the build tree BUILD into SCRATCH and builds and runs tests/install_client
# of the project SOURCE against it.
file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
# The package stands alone: nothing in it leads back to the sources or the build tree.
file(GLOB_RECURSE package ${prefix}/lib/*.cmake)
foreach(file IN LISTS package)
  file(READ ${file} text)
  foreach(folder IN ITEMS ${SOURCE} ${BUILD})
    string(FIND "${text}" "${folder}" place)
    if(NOT place EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()
file(GLOB_RECURSE tests_headers ${prefix}/include/*test*.h)
if(tests_headers)
  message(FATAL_ERROR "headers of tests are installed: ${tests_headers}")
endif()

run(${CMAKE_COMMAND} -S ${SOURCE}/tests/install_client -B ${SCRATCH}/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/client)
run(${prefix}/bin/vantage --version)
