# SPDX-License-Identifier: Apache-2.0
# Compiler settings, and the functions that turn a folder into a library or a test program.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

option(HEADLAND_WERROR "Warnings are errors" OFF)
set(HEADLAND_SANITIZE "" CACHE STRING "Sanitizers, as -fsanitize= takes them")

find_program(HEADLAND_CCACHE ccache)
if(HEADLAND_CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${HEADLAND_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${HEADLAND_CCACHE})
endif()

add_library(headland_flags INTERFACE)
target_compile_options(headland_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -Woverloaded-virtual
  -Wno-restrict  # GCC 12 warns wrongly on std::string + (bug 105651)
  # No fused multiply-add: the same bytes from every build type and processor of one architecture.
  -ffp-contract=off
  $<$<BOOL:${HEADLAND_WERROR}>:-Werror>)
if(HEADLAND_SANITIZE)
  target_compile_options(headland_flags INTERFACE -fsanitize=${HEADLAND_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(headland_flags INTERFACE -fsanitize=${HEADLAND_SANITIZE})
endif()

# headland_library(<folder> [EXCLUDE <sub-folder>...] [PUBLIC <lib>...] [PRIVATE <lib>...])
# The library headland::<last part of folder> from all sources below <folder>.
function(headland_library folder)
  cmake_parse_arguments(ARG "" "" "EXCLUDE;PUBLIC;PRIVATE" ${ARGN})
  get_filename_component(name ${folder} NAME)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.hpp)
  foreach(sub ${ARG_EXCLUDE})
    list(FILTER sources EXCLUDE REGEX "/${folder}/${sub}/")
    list(FILTER headers EXCLUDE REGEX "/${folder}/${sub}/")
  endforeach()
  list(FILTER headers EXCLUDE REGEX "/internal/")
  add_library(headland_${name} STATIC ${sources})
  add_library(headland::${name} ALIAS headland_${name})
  target_sources(headland_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR} FILES ${headers})
  target_include_directories(headland_${name} PUBLIC ${CMAKE_SOURCE_DIR})
  target_link_libraries(headland_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} headland_flags)
endfunction()

# headland_tests(<folder below tests/> <lib>...)
# One test program from tests/<folder>; a test in *_slow_test.cpp gets the label slow, all others fast.
function(headland_tests folder)
  string(REPLACE "/" "_" name ${folder})
  foreach(label fast slow)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/${folder}/*_test.cpp)
    if(label STREQUAL "slow")
      list(FILTER sources INCLUDE REGEX "_slow_test\\.cpp$")
    else()
      list(FILTER sources EXCLUDE REGEX "_slow_test\\.cpp$")
    endif()
    if(sources)
      set(target ${name}_${label}_tests)
      add_executable(${target} ${sources})
      target_link_libraries(${target} PRIVATE ${ARGN} GTest::gtest_main GTest::gmock headland_flags)
      target_compile_definitions(${target} PRIVATE HEADLAND_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
      gtest_discover_tests(${target} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
        PROPERTIES LABELS ${label} DISCOVERY_TIMEOUT 60)
    endif()
  endforeach()
endfunction()
