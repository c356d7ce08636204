// How much work a stretch of commands is, for guarding times against unequal work.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "engine/gl/objects.h"

namespace gfxrepro::gl {

/// What the commands between begin() and end() made the device do.
struct Work {
    std::uint64_t primitives = 0;   // handed to the pipeline by draws
    std::uint64_t fragments = 0;    // fragment shader invocations
    std::uint64_t invocations = 0;  // of compute shaders

    bool operator==(const Work&) const = default;
};

/// Counts Work by pipeline statistics, which no SampleQuery or PrimitiveQuery inside disturbs.
/// Devices without ARB_pipeline_statistics_query count nothing.
class WorkQuery {
  public:
    explicit WorkQuery(bool isSupported);
    void begin() const;
    void end() const;
    /// Of the last begin() … end(); waits for the device. Null where it is not supported.
    std::optional<Work> result() const;

  private:
    std::array<detail::Name<detail::deleteQuery>, 3> names_;
};

}  // namespace gfxrepro::gl
