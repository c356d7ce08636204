// The GPUs that a cluster gave to this task, as it says by CUDA_VISIBLE_DEVICES: EGL lists all.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gfxrepro::gl {

class GrantedGpus {
  public:
    /// `visible` as CUDA reads it: numbers in the order of `gpus` (UUIDs, as nvidiaGpus()) or
    /// beginnings of UUIDs, up to the first that is neither; nothing where it is not set.
    GrantedGpus(std::optional<std::string> visible, std::vector<std::string> gpus);
    static GrantedGpus fromEnvironment();

    /// Why a device of that UUID is not to be used; empty where it may be. Nothing is said of
    /// devices that are not among the GPUs.
    std::string whyNot(const std::string& uuid) const;

  private:
    std::optional<std::string> visible_;
    std::vector<std::string> gpus_, granted_;
};

}  // namespace gfxrepro::gl
