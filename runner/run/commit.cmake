# Writes HEADER with the commit of SOURCE_DIR ("unknown" outside of a git checkout) and its day, if it changed.
set(commit unknown)
set(day "")
find_package(Git QUIET)
if(GIT_FOUND)
    execute_process(COMMAND "${GIT_EXECUTABLE}" -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 --exclude=*
        OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
    if(status EQUAL 0)
        set(commit "${described}")
        execute_process(COMMAND "${GIT_EXECUTABLE}" -C "${SOURCE_DIR}" log -1 --format=%cs
            OUTPUT_VARIABLE day OUTPUT_STRIP_TRAILING_WHITESPACE)
    endif()
endif()
file(CONFIGURE OUTPUT "${HEADER}" CONTENT
    "#define GFXREPRO_COMMIT \"${commit}\"\n#define GFXREPRO_COMMIT_DAY \"${day}\"\n")
