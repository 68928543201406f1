# cmake -DSOURCE=FOLDER -DOUTPUT=FILE -P built_from.cmake: which commit is being built, as a source
# file. Run at every build; writes only when something has changed.
find_program(git git)
set(commit unknown)
set(changed unknown)
if(git)
    execute_process(COMMAND ${git} -C ${SOURCE} rev-parse HEAD
                    OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE
                    RESULT_VARIABLE failed ERROR_QUIET)
    if(NOT failed)
        set(commit ${head})
        execute_process(COMMAND ${git} -C ${SOURCE} status --porcelain --untracked-files=no
                        OUTPUT_VARIABLE changes ERROR_QUIET)
        if(changes STREQUAL "")
            set(changed no)
        else()
            set(changed yes)
        endif()
    endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "experiment/built_from.h"

namespace experiment {

const char* const kBuiltFromCommit = "@commit@";
const char* const kBuiltFromChangedSources = "@changed@";

}  // namespace experiment
]] @ONLY)
