# The network readers: with libFuzzer a program to run by hand, otherwise a short run on mutations
# of files that the writers make, so the seeds are never out of date.
if(SCALEFCN_USE_LIBFUZZER)
    scalefcn_add_fuzz_target(network_fuzz SOURCES network_fuzz.cpp LINK sample_networks)
elseif(SCALEFCN_BUILD_TESTS)
    add_executable(network_fuzz network_fuzz.cpp network_fuzz_run.cpp)
    target_include_directories(network_fuzz PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(network_fuzz PRIVATE sample_networks scalefcn_warnings)
    add_test(NAME fuzz.network_fuzz COMMAND network_fuzz 20000)
    set_tests_properties(fuzz.network_fuzz PROPERTIES TIMEOUT 600)
endif()
