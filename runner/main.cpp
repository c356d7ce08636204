#include "runner/cli/cli.h"
#include "runner/technique/technique.h"
#include "scenes/registry.h"

int main(int argc, char** argv) {
    return gfxrepro::cli::run(argc, argv, gfxrepro::technique::registeredTechniques(),
                              gfxrepro::scene::registeredGenerators());
}
