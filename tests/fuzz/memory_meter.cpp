#include "tests/fuzz/memory_meter.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

// operator new has no other place to keep its count.
namespace {
std::atomic<std::size_t> usedBytes = 0;
std::atomic<std::size_t> peakBytes = 0;
std::atomic<std::size_t> startBytes = 0;
}  // namespace

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    void* memory = std::malloc(size);
    if (memory == nullptr) return nullptr;
    const std::size_t used = usedBytes += ::malloc_usable_size(memory);
    std::size_t peak = peakBytes;
    while (used > peak && !peakBytes.compare_exchange_weak(peak, used)) {
    }
    return memory;
}

void* operator new(std::size_t size) {
    if (void* memory = ::operator new(size, std::nothrow)) return memory;
    throw std::bad_alloc();
}

void* operator new[](std::size_t size) {
    return ::operator new(size);
}

void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return ::operator new(size, std::nothrow);
}

void operator delete(void* memory) noexcept {
    if (memory != nullptr) usedBytes -= ::malloc_usable_size(memory);
    std::free(memory);
}

void operator delete[](void* memory) noexcept {
    ::operator delete(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    ::operator delete(memory);
}

void operator delete[](void* memory, std::size_t) noexcept {
    ::operator delete(memory);
}

void operator delete(void* memory, const std::nothrow_t&) noexcept {
    ::operator delete(memory);
}

void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    ::operator delete(memory);
}

namespace gfxrepro::test {

void resetPeakMemory() {
    startBytes = usedBytes.load();
    peakBytes = usedBytes.load();
}

std::size_t peakMemoryBytes() {
    return peakBytes - startBytes;
}

}  // namespace gfxrepro::test
