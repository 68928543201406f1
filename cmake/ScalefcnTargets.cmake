# One interface target carries the warnings; every library is made by scalefcn_add_library so that
# names, include paths and installation stay uniform.

# Packages are looked for where they are needed first; tests link to the same ones.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)

add_library(scalefcn_warnings INTERFACE)
target_compile_options(scalefcn_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow
                       -Wnon-virtual-dtor -Woverloaded-virtual)
# GCC 12 takes "text" + std::string for a copy of overlapping memory (its bug 105329, mended in 13).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12
   AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(scalefcn_warnings INTERFACE -Wno-restrict)
endif()

# scalefcn_add_library(NAME ROOT <include root> SOURCES ... HEADERS ... LINK ... LINK_PRIVATE ...)
# makes target NAME with alias scalefcn::NAME; HEADERS (relative to ROOT) are installed.
function(scalefcn_add_library name)
    cmake_parse_arguments(ARG "" "ROOT" "SOURCES;HEADERS;LINK;LINK_PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    add_library(scalefcn::${name} ALIAS ${name})
    set_target_properties(${name} PROPERTIES OUTPUT_NAME scalefcn_${name})
    target_compile_features(${name} PUBLIC cxx_std_20)
    target_include_directories(${name} PUBLIC
        $<BUILD_INTERFACE:${ARG_ROOT}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/scalefcn>)
    target_link_libraries(${name} PUBLIC ${ARG_LINK}
                          PRIVATE $<BUILD_INTERFACE:scalefcn_warnings> ${ARG_LINK_PRIVATE})
    install(TARGETS ${name} EXPORT scalefcnTargets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    foreach(header IN LISTS ARG_HEADERS)
        cmake_path(GET header PARENT_PATH folder)
        install(FILES ${ARG_ROOT}/${header}
                DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/scalefcn/${folder})
    endforeach()
endfunction()

# scalefcn_add_test(NAME SOURCES ... LINK ...): one GoogleTest program, its cases registered.
function(scalefcn_add_test name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(${name} PRIVATE ${ARG_LINK} scalefcn_warnings GTest::gtest_main)
    target_compile_definitions(${name} PRIVATE
        SCALEFCN_SOURCE_DIR="${PROJECT_SOURCE_DIR}" SCALEFCN_BINARY_DIR="${PROJECT_BINARY_DIR}")
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()
