// File descriptors.
#pragma once

#include <unistd.h>

#include <string>
#include <utility>

namespace gfxrepro {

/// Closes itself; below 0 there is nothing to close.
class Descriptor {
  public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor() { close(); }
    int get() const { return fd_; }
    void close() {
        if (fd_ >= 0) ::close(fd_);
        fd_ = -1;
    }

  private:
    int fd_;
};

/// Appends what can be read now to `text`, some MiB of it at most, lest one that never ceases to
/// write is all that is looked after; false at the end of the stream.
bool readAvailable(int fd, std::string& text);

}  // namespace gfxrepro
