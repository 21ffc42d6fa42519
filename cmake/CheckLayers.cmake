# SPDX-FileCopyrightText: The Vantage authors
# SPDX-License-Identifier: MIT
cmake_minimum_required(VERSION 3.25)
# Fails when a module includes a module right of it.
#   cmake -DMODULES="base;geometry;..." -DROOT=src/vantage -P CheckLayers.cmake
set(allowed "")
foreach(module IN LISTS MODULES)
  list(APPEND allowed ${module})
  file(GLOB files ${ROOT}/${module}/*.h ${ROOT}/${module}/*.cc)
  foreach(file IN LISTS files)
    file(STRINGS ${file} includes REGEX "^#include \"vantage/")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^#include \"vantage/([^/\"]+)/.*" "\\1" used "${line}")
      if(NOT used IN_LIST allowed)
        message(SEND_ERROR "${file}: module '${module}' may not include module '${used}' "
                           "(order: ${MODULES})")
      endif()
    endforeach()
  endforeach()
endforeach()
