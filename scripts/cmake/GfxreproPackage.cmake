# What `cmake --install` puts beside program, shaders and configs, and the Debian package of all of it.
# The program itself prints its man page and completions.

set(shared "${CMAKE_BINARY_DIR}/share")
file(MAKE_DIRECTORY "${shared}")
find_program(GFXREPRO_GZIP gzip REQUIRED)
set(man "${shared}/gfxrepro.1.gz")
add_custom_command(OUTPUT "${man}"
    COMMAND gfxrepro man > "${shared}/gfxrepro.1"
    COMMAND "${GFXREPRO_GZIP}" -9nf "${shared}/gfxrepro.1"
    DEPENDS gfxrepro VERBATIM)
install(FILES "${man}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
set(made "${man}")

# add_completion(SHELL FOLDER NAME): installed where Debian's packages have theirs.
function(add_completion shell folder name)
    set(script "${shared}/completion.${shell}")
    add_custom_command(OUTPUT "${script}"
        COMMAND gfxrepro completion ${shell} > "${script}" DEPENDS gfxrepro VERBATIM)
    install(FILES "${script}" DESTINATION "${CMAKE_INSTALL_DATADIR}/${folder}" RENAME ${name})
    set(made "${made};${script}" PARENT_SCOPE)
endfunction()
add_completion(bash bash-completion/completions gfxrepro)
add_completion(fish fish/vendor_completions.d gfxrepro.fish)
add_completion(zsh zsh/vendor-completions _gfxrepro)
add_custom_target(gfxrepro_share ALL DEPENDS ${made})

install(PROGRAMS "${CMAKE_SOURCE_DIR}/scripts/fetch-assets" "${CMAKE_SOURCE_DIR}/scripts/nightly"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/gfxrepro/scripts")
# Of the kept results, what a report reads.
install(DIRECTORY "${CMAKE_SOURCE_DIR}/results/sensitivity" "${CMAKE_SOURCE_DIR}/results/calibration"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/gfxrepro/results" FILES_MATCHING PATTERN "*.csv")
install(FILES "${CMAKE_SOURCE_DIR}/README.md" "${CMAKE_SOURCE_DIR}/GUIDE.md" "${CMAKE_SOURCE_DIR}/CHANGELOG.md" "${CMAKE_SOURCE_DIR}/CITATION.cff"
    DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# Debian's policy wants the notice with a pointer to the licence, and a changelog of its own form.
set(developers "gfxrepro developers <developers@gfxrepro.invalid>")
file(CONFIGURE OUTPUT "${shared}/copyright" CONTENT
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: gfxrepro

Files: *
Copyright: 2026 gfxrepro developers
License: Apache-2.0
Comment: The notices of the code of others that is compiled in are in licenses/.

License: Apache-2.0
 Licensed under the Apache License, Version 2.0 (the \"License\"); you may not use
 this file except in compliance with the License. You may obtain a copy of the
 License at http://www.apache.org/licenses/LICENSE-2.0
 .
 Unless required by applicable law or agreed to in writing, software distributed
 under the License is distributed on an \"AS IS\" BASIS, WITHOUT WARRANTIES OR
 CONDITIONS OF ANY KIND, either express or implied. See the License for the
 specific language governing permissions and limitations under the License.
 .
 On Debian systems its text is in /usr/share/common-licenses/Apache-2.0.
")
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT "${shared}/changelog" CONTENT
"gfxrepro (${PROJECT_VERSION}) unstable; urgency=medium

  * What is new stands in CHANGELOG.md.

 -- ${developers}  ${now}
")
execute_process(COMMAND "${GFXREPRO_GZIP}" -9nf "${shared}/changelog" COMMAND_ERROR_IS_FATAL ANY)
install(FILES "${shared}/copyright" "${shared}/changelog.gz" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(CODE "execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND \"${CMAKE_SOURCE_DIR}/scripts/notices\"
    \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/licenses\" \"${CMAKE_BINARY_DIR}\")")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gfxrepro)
set(CPACK_PACKAGE_CONTACT "${developers}")
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/package")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# GLVND finds its drivers at run time: no library says so. A GPU's own driver serves instead of Mesa's.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libegl-mesa0, libgl1-mesa-dri")
set(CPACK_PACKAGE_DESCRIPTION
"Experiments are YAML files: a published table, figure or section each, with
its printed numbers, what is measured for it, and the claims that must
follow. They run headless through EGL and OpenGL 4.5, on a GPU or on Mesa's
software device; what comes out is tables, verdicts and a report.")
include(CPack)
