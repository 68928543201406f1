# The network readers' fuzz target: a short run on mutated files as a test, and with Clang and
# SCALEFCN_BUILD_FUZZERS a libFuzzer program.
if(SCALEFCN_BUILD_TESTS)
    add_executable(network_fuzz_run ${CMAKE_CURRENT_LIST_DIR}/network_fuzz.cpp
                                    ${CMAKE_CURRENT_LIST_DIR}/network_fuzz_run.cpp)
    target_include_directories(network_fuzz_run PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(network_fuzz_run PRIVATE sample_networks scalefcn_warnings)
    add_test(NAME network_fuzz COMMAND network_fuzz_run 20000)
    set_tests_properties(network_fuzz PROPERTIES TIMEOUT 600)
endif()
if(SCALEFCN_BUILD_FUZZERS AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_executable(network_fuzzer ${CMAKE_CURRENT_LIST_DIR}/network_fuzz.cpp)
    target_include_directories(network_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(network_fuzzer PRIVATE sample_networks scalefcn_warnings)
    target_compile_options(network_fuzzer PRIVATE -fsanitize=fuzzer,address)
    target_link_options(network_fuzzer PRIVATE -fsanitize=fuzzer,address)
endif()
