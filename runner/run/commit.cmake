# Writes HEADER with the commit of SOURCE_DIR ("unknown" outside of a git checkout), if it changed.
set(commit unknown)
find_package(Git QUIET)
if(GIT_FOUND)
    execute_process(COMMAND "${GIT_EXECUTABLE}" -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12
        OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
    if(status EQUAL 0)
        set(commit "${described}")
    endif()
endif()
file(CONFIGURE OUTPUT "${HEADER}" CONTENT "#define GFXREPRO_COMMIT \"${commit}\"\n")
