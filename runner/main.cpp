#include "runner/cli/cli.h"
#include "runner/cli/cpp_library.h"
#include "runner/technique/technique.h"
#include "scenes/registry.h"

int main(int argc, char** argv) {
    gfxrepro::cli::takeNewerCppLibrary(argv);
    return gfxrepro::cli::run(argc, argv, gfxrepro::technique::registeredTechniques(),
                              gfxrepro::scene::registeredGenerators());
}
