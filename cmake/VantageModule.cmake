# SPDX-FileCopyrightText: The Vantage authors
# SPDX-License-Identifier: MIT

# The modules from left to right: a module includes only modules left of it.
# cmake/CheckLayers.cmake enforces this at every build.
set(VANTAGE_MODULES base geometry video scene background occupancy tracks linking identity
                    metrics simulation rendering pipeline experiments)

# Settings for our own code; never leak to consumers.
add_library(vantage_settings INTERFACE)
target_compile_features(vantage_settings INTERFACE cxx_std_20)
target_include_directories(vantage_settings INTERFACE ${PROJECT_SOURCE_DIR}/src
                                                      ${PROJECT_BINARY_DIR}/generated)
# -ffp-contract=off: equal inputs give equal bits whatever the compiler fuses.
target_compile_options(vantage_settings INTERFACE -ffp-contract=off)
if(VANTAGE_DEVELOPER_MODE)
  target_compile_options(vantage_settings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                                   -Woverloaded-virtual -Wold-style-cast -Werror)
endif()
if(VANTAGE_SANITIZE)
  target_compile_options(vantage_settings INTERFACE -fsanitize=${VANTAGE_SANITIZE}
                                                    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(vantage_settings INTERFACE -fsanitize=${VANTAGE_SANITIZE})
endif()
if(VANTAGE_COVERAGE)
  target_compile_options(vantage_settings INTERFACE --coverage)
  target_link_options(vantage_settings INTERFACE --coverage)
endif()

# Third-party headers are not ours to warn about: all come as SYSTEM.
add_library(vantage_opencv INTERFACE)
target_include_directories(vantage_opencv SYSTEM INTERFACE
                           "$<BUILD_INTERFACE:${OpenCV_INCLUDE_DIRS}>")
target_link_libraries(vantage_opencv INTERFACE opencv_core opencv_imgproc opencv_imgcodecs
                                               opencv_videoio opencv_calib3d opencv_video)
add_library(vantage_dependencies INTERFACE)
target_link_libraries(vantage_dependencies INTERFACE vantage_opencv Eigen3::Eigen TBB::tbb fmt::fmt
                                                     tl::expected nlohmann_json::nlohmann_json)

# vantage_add_module(<name> SOURCES <file>... TESTS <file>... [LINK <library>...] [TEST_LINK <library>...])
#   Adds src/vantage/<name> to the library and its tests as one executable, vantage_<name>_test.
#   LINK: libraries beyond vantage_dependencies that only this module's sources need.
function(vantage_add_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;TESTS;LINK;TEST_LINK")
  if(NOT name IN_LIST VANTAGE_MODULES)
    message(FATAL_ERROR "module '${name}' is not in VANTAGE_MODULES (cmake/VantageModule.cmake)")
  endif()
  add_library(vantage_${name} OBJECT ${arg_SOURCES})
  target_link_libraries(vantage_${name} PRIVATE vantage_settings PUBLIC vantage_dependencies
                                        PRIVATE ${arg_LINK})
  target_sources(vantage PRIVATE $<TARGET_OBJECTS:vantage_${name}>)
  target_link_libraries(vantage PRIVATE ${arg_LINK})
  add_dependencies(vantage_${name} vantage_layers)
  if(VANTAGE_DEVELOPER_MODE AND arg_TESTS)
    vantage_add_test(vantage_${name}_test SOURCES ${arg_TESTS} LINK ${arg_LINK} ${arg_TEST_LINK})
  endif()
endfunction()

# vantage_add_test(<target> SOURCES <file>... [LINK <library>...])
#   Tests that measure on research data look in VANTAGE_TEST_DATA (environment), else ../shared/data
#   beside the checkout, and are skipped, saying so, where it is absent.
function(vantage_add_test target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINK")
  add_executable(${target} ${arg_SOURCES})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  target_link_libraries(${target} PRIVATE vantage_settings vantage GTest::gmock_main rapidcheck
                                          ${arg_LINK})
  target_compile_definitions(${target} PRIVATE VANTAGE_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                               VANTAGE_BINARY_DIR="${PROJECT_BINARY_DIR}")
  include(GoogleTest)
  gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
