# The four ways a target comes into being here: module, technique, program, test.

add_library(gfxrepro_options INTERFACE)
target_compile_features(gfxrepro_options INTERFACE cxx_std_20)
target_include_directories(gfxrepro_options INTERFACE "${CMAKE_SOURCE_DIR}")
# Expressions are evaluated as written: the CPU references are compared with shaders bit for bit.
target_compile_options(gfxrepro_options INTERFACE -ffp-contract=off)
if(GFXREPRO_SANITIZE)
    # What goes through a null pointer AddressSanitizer reports. A reference to nothing, which nobody reads, is found each night
    # (sanitize-gl): to look for it takes a compiler 6 % longer.
    target_compile_options(gfxrepro_options INTERFACE
        -fsanitize=address,undefined $<$<NOT:$<BOOL:${GFXREPRO_BUILD_GL}>>:-fno-sanitize=null>
        -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(gfxrepro_options INTERFACE -fsanitize=address,undefined)
endif()
if(GFXREPRO_SANITIZE_THREADS)
    target_include_directories(gfxrepro_options INTERFACE "${CMAKE_SOURCE_DIR}/tests/threads")
    target_compile_options(gfxrepro_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(gfxrepro_options INTERFACE -fsanitize=thread)
endif()

# Where sources compile one by one: as one unit they shadow names of each other.
add_library(gfxrepro_warnings INTERFACE)
if(CMAKE_UNITY_BUILD)
    target_compile_options(gfxrepro_warnings INTERFACE -Wno-subobject-linkage)
else()
    target_compile_options(gfxrepro_warnings INTERFACE
        -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion $<$<BOOL:${GFXREPRO_WERROR}>:-Werror>)
endif()

set(CMAKE_CXX_EXTENSIONS OFF)

# Tests take longer to compile than to run. As one unit, what is local to a source seems to be another one's.
set(GFXREPRO_TEST_OPTIONS -O0 -Wno-subobject-linkage)

# gfxrepro_precompiled(TARGET COMMON OPTIONS … HEADERS … LINK …): what most sources of such targets include is compiled once, as
# COMMON. It is headers of others alone, so that a header of ours still compiles without what its source includes. Those of others
# that it forgets `check_style` names, and preset `clang`, which compiles without.
function(gfxrepro_precompiled target common)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        return()
    endif()
    cmake_parse_arguments(arg "" "" "OPTIONS;HEADERS;LINK" ${ARGN})
    if(NOT TARGET ${common})
        file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/${common}.cpp" CONTENT "")
        add_library(${common} OBJECT "${CMAKE_BINARY_DIR}/${common}.cpp")
        target_compile_options(${common} PRIVATE -fpch-preprocess ${arg_OPTIONS})
        target_link_libraries(${common} PRIVATE gfxrepro_options fmt::fmt nlohmann_json::nlohmann_json ${arg_LINK})
        target_precompile_headers(${common} PRIVATE
            <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <sstream> <string> <vector>
            <fmt/format.h> ${arg_HEADERS})
    endif()
    # GCC 12 takes the short form of a moved string for one that is read beyond its end.
    target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
    target_precompile_headers(${target} REUSE_FROM ${common})
endfunction()

# gfxrepro_precompiled_sources(TARGET COLD): where sources compile one by one, in the two ways that modules are optimized.
function(gfxrepro_precompiled_sources target cold)
    if(CMAKE_UNITY_BUILD)
        return()
    endif()
    if(cold)
        gfxrepro_precompiled(${target} gfxrepro_common_cold OPTIONS ${GFXREPRO_COLD_OPTIONS} HEADERS <nlohmann/json.hpp>)
    else()
        gfxrepro_precompiled(${target} gfxrepro_common HEADERS <glm/glm.hpp> LINK glm::glm)
    endif()
endfunction()

# gfxrepro_verify_headers(TARGET [targets …]): every header beside the target's sources compiles alone, with the
# targets that those have. One with a source of its name does so there: sources begin with their header (check_style).
function(gfxrepro_verify_headers target)
    if(NOT GFXREPRO_VERIFY_HEADERS)
        return()
    endif()
    # scripts/build configures each time. CONFIGURE_DEPENDS would keep `ninja -n`, which counts, from what is to be built.
    file(GLOB headers "${CMAKE_CURRENT_SOURCE_DIR}/*.h")
    set(units)
    foreach(header IN LISTS headers)
        file(RELATIVE_PATH path "${CMAKE_SOURCE_DIR}" "${header}")
        string(REGEX REPLACE "h$" "cpp" source "${header}")
        if(EXISTS "${source}" AND NOT CMAKE_UNITY_BUILD)
            continue()
        endif()
        set(unit "${CMAKE_CURRENT_BINARY_DIR}/headers/${path}.cpp")
        file(CONFIGURE OUTPUT "${unit}" CONTENT "#include \"${path}\"\n")
        list(APPEND units "${unit}")
    endforeach()
    if(units)
        add_library(${target}_headers OBJECT ${units})
        set_target_properties(${target}_headers PROPERTIES UNITY_BUILD OFF)
        target_link_libraries(${target}_headers PRIVATE ${target} gfxrepro_warnings ${ARGN})
    endif()
endfunction()

# Of what no technique spends its time in. Sanitized it takes longer to build than to run.
set(GFXREPRO_COLD_OPTIONS $<$<CONFIG:Release>:-O1> $<$<BOOL:${GFXREPRO_SANITIZE}>:-O0>)

# gfxrepro_module(NAME [COLD] SOURCES … [PUBLIC targets …] [PRIVATE targets …]) → library gfxrepro_NAME
# COLD: no technique spends its time in it, and so it is optimized less, which builds faster.
function(gfxrepro_module name)
    cmake_parse_arguments(arg "COLD" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    add_library(gfxrepro_${name} STATIC ${arg_SOURCES})
    if(arg_COLD)
        target_compile_options(gfxrepro_${name} PRIVATE ${GFXREPRO_COLD_OPTIONS})
    endif()
    gfxrepro_precompiled_sources(gfxrepro_${name} ${arg_COLD})
    target_link_libraries(gfxrepro_${name}
        PUBLIC gfxrepro_options ${arg_PUBLIC}
        PRIVATE gfxrepro_warnings ${arg_PRIVATE})
    gfxrepro_verify_headers(gfxrepro_${name} ${arg_PRIVATE})
endfunction()

# add_technique(NAME [COLD] SOURCES … SHADERS … [PRIVATE targets …]) → library technique_NAME; its shaders are
# copied to <build>/shaders/NAME and installed beside the program. Every technique has techniques/kit.
function(add_technique name)
    cmake_parse_arguments(arg "COLD" "" "SOURCES;SHADERS;PRIVATE" ${ARGN})
    add_library(technique_${name} STATIC ${arg_SOURCES})
    if(arg_COLD)
        target_compile_options(technique_${name} PRIVATE ${GFXREPRO_COLD_OPTIONS})
    endif()
    gfxrepro_precompiled_sources(technique_${name} ${arg_COLD})
    target_link_libraries(technique_${name}
        PUBLIC gfxrepro_technique techniques_kit
        PRIVATE gfxrepro_warnings gfxrepro_raycast gfxrepro_metrics gfxrepro_gpu_scene ${arg_PRIVATE})
    gfxrepro_verify_headers(technique_${name} ${arg_PRIVATE})
    gfxrepro_shaders(technique_${name} ${name} ${arg_SHADERS})
endfunction()

# gfxrepro_shaders(TARGET FOLDER files …): copied to <build>/shaders/FOLDER whenever they change.
function(gfxrepro_shaders target folder)
    set(copies)
    foreach(shader IN LISTS ARGN)
        get_filename_component(file "${shader}" NAME)
        set(copy "${CMAKE_BINARY_DIR}/shaders/${folder}/${file}")
        add_custom_command(OUTPUT "${copy}"
            COMMAND "${CMAKE_COMMAND}" -E copy "${CMAKE_CURRENT_SOURCE_DIR}/${shader}" "${copy}"
            DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${shader}" VERBATIM)
        list(APPEND copies "${copy}")
    endforeach()
    if(copies)
        add_custom_target(${target}_shaders ALL DEPENDS ${copies})
        add_dependencies(${target} ${target}_shaders)
        install(FILES ${copies} DESTINATION "${CMAKE_INSTALL_DATADIR}/gfxrepro/shaders/${folder}")
    endif()
endfunction()

# gfxrepro_test(NAME [COLD] [SERIAL] [WHOLE] LABEL label SOURCES … LINK targets …) → one GoogleTest program, one ctest entry a case;
# COLD: a unit test that computes next to nothing. SERIAL: beside no other test. WHOLE: one entry for all, as cases share what takes long to make; none may be skipped.
# A dozen sources are one unit, in every preset: most of what a test takes to compile are headers.
function(gfxrepro_test name)
    cmake_parse_arguments(arg "COLD;SERIAL;WHOLE" "LABEL" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${arg_SOURCES})
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
    set(options ${GFXREPRO_TEST_OPTIONS})
    set(common gfxrepro_test_common)
    if(arg_LABEL STREQUAL "unit" AND NOT arg_COLD)  # computes and simulates by itself
        list(APPEND options $<$<CONFIG:Release>:-O1>)
        set(common gfxrepro_unit_common)
    endif()
    target_compile_options(${name} PRIVATE ${options})
    gfxrepro_precompiled(${name} ${common} OPTIONS ${options} HEADERS <gmock/gmock.h> <gtest/gtest.h> LINK GTest::gmock)
    target_link_libraries(${name} PRIVATE gfxrepro_test_support ${arg_LINK} GTest::gmock GTest::gtest_main)
    include(GoogleTest)
    # Under ThreadSanitizer simulations of a minute take ten.
    set(limit_s 300)
    if(GFXREPRO_SANITIZE_THREADS)
        set(limit_s 1800)
    endif()
    if(arg_WHOLE)
        add_test(NAME ${name} COMMAND ${name})
        set_tests_properties(${name} PROPERTIES LABELS "${arg_LABEL}" TIMEOUT 1800
            ENVIRONMENT GTEST_BRIEF=1)  # of what fails the errors alone
        return()
    endif()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES LABELS "${arg_LABEL}" TIMEOUT ${limit_s}
                         RUN_SERIAL ${arg_SERIAL})
endfunction()
