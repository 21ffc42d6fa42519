# SPDX-FileCopyrightText: The Vantage authors
# SPDX-License-Identifier: MIT

# `cmake --install` gives headers, libvantage.a, the program, and a package that
# find_package(vantage) finds:
#
#   find_package(vantage REQUIRED)
#   target_link_libraries(mine PRIVATE vantage::vantage)
include(CMakePackageConfigHelpers)
set(VANTAGE_INSTALL_CMAKEDIR ${CMAKE_INSTALL_LIBDIR}/cmake/vantage)

foreach(module IN LISTS VANTAGE_MODULES)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/vantage/${module}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vantage
          FILES_MATCHING PATTERN "*.h"
          PATTERN "test_*.h" EXCLUDE PATTERN "*_oracle.h" EXCLUDE # of the tests
          PATTERN "*-inl.h" EXCLUDE)                              # of kernels
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/vantage/base/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vantage/base)

# The interface libraries travel with it; vantage_settings and the modules' object libraries do not.
set_target_properties(vantage_dependencies PROPERTIES EXPORT_NAME dependencies)
set_target_properties(vantage_opencv PROPERTIES EXPORT_NAME opencv)
install(TARGETS vantage vantage_dependencies vantage_opencv EXPORT vantageTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT vantageTargets NAMESPACE vantage:: DESTINATION ${VANTAGE_INSTALL_CMAKEDIR})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/vantageConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/generated/vantageConfig.cmake
                              INSTALL_DESTINATION ${VANTAGE_INSTALL_CMAKEDIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/vantageConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/vantageConfig.cmake
              ${PROJECT_BINARY_DIR}/generated/vantageConfigVersion.cmake
        DESTINATION ${VANTAGE_INSTALL_CMAKEDIR})

# Installs into a scratch folder and builds and runs a client against it.
if(VANTAGE_DEVELOPER_MODE)
  set(client_flags "")
  if(VANTAGE_SANITIZE)
    set(client_flags "-fsanitize=${VANTAGE_SANITIZE}")
  elseif(VANTAGE_COVERAGE)
    set(client_flags "--coverage")
  endif()
  add_test(NAME install.client
           COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DBUILD=${PROJECT_BINARY_DIR}
                   -DSCRATCH=${PROJECT_BINARY_DIR}/tests/install_client
                   -DGENERATOR=${CMAKE_GENERATOR} -DCXX=${CMAKE_CXX_COMPILER}
                   -DFLAGS=${client_flags}
                   -P ${PROJECT_SOURCE_DIR}/cmake/TestInstall.cmake)
  set_tests_properties(install.client PROPERTIES TIMEOUT 300)
endif()
