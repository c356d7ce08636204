// Seeded random numbers that are the same on every machine.
#pragma once

#include <cstdint>

namespace gfxrepro {

/// PCG-XSH-RR 64/32 (O'Neill 2014). The distributions of <random> differ between libraries; these
/// do not.
class Random {
  public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1) | 1) {
        next();
        state_ += seed;
        next();
    }

    /// Uniform over all 32-bit values.
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const auto xorShifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        const auto rotation = static_cast<std::uint32_t>(old >> 59);
        return (xorShifted >> rotation) | (xorShifted << ((32 - rotation) & 31));
    }

    /// Uniform in [0, 1), 24 bits.
    float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24F; }
    float uniform(float low, float high) { return low + (high - low) * uniform(); }
    /// Uniform in [0, count), without bias worth speaking of for counts far below 2³².
    std::uint32_t index(std::uint32_t count) {
        return static_cast<std::uint32_t>((std::uint64_t{next()} * count) >> 32);
    }

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_;
};

}  // namespace gfxrepro
