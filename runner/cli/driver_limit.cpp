#include "runner/cli/driver_limit.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

#include "runner/cli/commands.h"
#include "runner/run/worker_handle.h"

namespace gfxrepro::cli {

namespace {

void giveUp(int) {
    static constexpr std::string_view kText = "gfxrepro: a driver did not answer in time\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kText.data(), kText.size());
    ::_exit(kExitNoDevice);
}

}  // namespace

DriverLimit::DriverLimit() {
    std::signal(SIGALRM, giveUp);
    ::alarm(static_cast<unsigned>(run::WorkerHandle::startLimit().count()));
}

DriverLimit::~DriverLimit() {
    ::alarm(0);
}

}  // namespace gfxrepro::cli
