// A limit for drivers that are asked in this process, where one that does not answer would hold it
// for ever.
#pragma once

namespace gfxrepro::cli {

/// While it lives: the program ends with kExitNoDevice after WorkerHandle::startLimit().
class DriverLimit {
  public:
    DriverLimit();
    ~DriverLimit();
    DriverLimit(const DriverLimit&) = delete;
    DriverLimit& operator=(const DriverLimit&) = delete;
};

}  // namespace gfxrepro::cli
