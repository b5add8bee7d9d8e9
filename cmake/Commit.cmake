# cmake -DSOURCE=... -DOUTPUT=... -P Commit.cmake: write the C++ source that knows the commit the program is built from.
# Run before every build; the file changes only with the commit. Empty outside of a checkout.
function(git result)
    execute_process(COMMAND git -C ${SOURCE} ${ARGN} OUTPUT_VARIABLE text OUTPUT_STRIP_TRAILING_WHITESPACE
                    ERROR_QUIET RESULT_VARIABLE failed)
    if(failed)
        set(text "")
    endif()
    set(${result} "${text}" PARENT_SCOPE)
endfunction()

git(top rev-parse --show-toplevel)
file(REAL_PATH ${SOURCE} here)
set(commit "")
if(top STREQUAL here)
    git(commit rev-parse --short=10 HEAD)
    git(changes status --porcelain --untracked-files=no)
    if(NOT changes STREQUAL "")
        string(APPEND commit " with changes")
    endif()
endif()

file(WRITE ${OUTPUT}.new "#include \"app/commit.h\"

namespace app
{
std::string commit()
{
    return \"${commit}\";
}
} // namespace app
")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)
file(REMOVE ${OUTPUT}.new)
