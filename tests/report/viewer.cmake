# The 3D viewer: its modules with Node.js, and a report in headless Chromium. Exit code 77 of the
# scripts, or a missing Node.js, counts as skipped.
set(viewer_node "command -v node >/dev/null || { echo 'skipped: Node.js is not installed'; exit 77; }")
add_test(NAME viewer.modules
         COMMAND sh -c "${viewer_node}; exec node --test '${PROJECT_SOURCE_DIR}/viewer/tests/unit'")
add_test(NAME viewer.browser
         COMMAND sh -c "${viewer_node}; exec node '${PROJECT_SOURCE_DIR}/viewer/tests/report_test.mjs' \
'$<TARGET_FILE:scalefcn>' '${CMAKE_CURRENT_BINARY_DIR}/viewer'")
set_tests_properties(viewer.modules viewer.browser PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)
