#include "runner/cli/driver_limit.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

#include "runner/batch/worker_handle.h"
#include "runner/cli/commands.h"

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
    ::alarm(static_cast<unsigned>(batch::WorkerHandle::startLimit().count()));
}

DriverLimit::~DriverLimit() {
    ::alarm(0);
}

}  // namespace gfxrepro::cli
